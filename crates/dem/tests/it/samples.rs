//! The meaning of stored values: types, sentinels, masks, units, bands.

use std::fs;
use std::path::{Path, PathBuf};

use corniche_dem::{Dem, OpenOptions};
use gdal::Metadata;
use gdal::raster::Buffer;
use gdal::raster::{ColorEntry, ColorInterpretation, ColorTable, GdalType, PaletteInterpretation};

use crate::fixture::{Raster, Space, all, check_heights, check_refused, open, plan};

const UTM: [f64; 6] = [500_000.0, 10.0, 0.0, 5_200_050.0, 0.0, -10.0];

/// A row of values, repeated over five rows.
fn row<T: GdalType + Copy>(folder: &Path, name: &str, raster: Raster<'_>, values: &[T]) -> PathBuf {
    let raster = Raster { size: [values.len(), 5], ..raster };
    raster.write(folder, name, |at| values[((at[0] - UTM[0]) / 10.0) as usize])
}

fn raster<'a>() -> Raster<'a> {
    Raster::new(32632, [0, 0], UTM)
}

/// The heights of the row, exactly.
fn check(name: &str, path: PathBuf, options: &OpenOptions, expected: &[Option<f64>]) {
    let dem = Dem::open(&[path], options).unwrap_or_else(|error| panic!("{name}: {error}"));
    let plan = plan(&dem);
    let heights = dem.reader(&plan).window(all(&plan)).unwrap().heights;
    let found: Vec<Option<f32>> = (0..expected.len()).map(|c| heights.height(c, 2)).collect();
    let expected: Vec<Option<f32>> =
        expected.iter().map(|height_m| height_m.map(|height_m| height_m as f32)).collect();
    assert_eq!(found, expected, "{name}");
}

#[test]
fn every_real_type_gives_its_values() {
    let folder = tempfile::tempdir().unwrap();
    let (at, given) = (folder.path(), OpenOptions::default());
    let u8s = row(at, "u8.tif", raster(), &[0_u8, 1, 255]);
    check("Byte", u8s, &given, &[Some(0.0), Some(1.0), Some(255.0)]);
    let signed = row(
        at,
        "i8.tif",
        raster().created(&["PIXELTYPE=SIGNEDBYTE"]).nodata(-128.0),
        &[251_u8, 127, 128],
    );
    check("Int8", signed, &given, &[Some(-5.0), Some(127.0), None]);
    let u16s = row(at, "u16.tif", raster().nodata(65_535.0), &[0_u16, 32_768, 65_535]);
    check("UInt16", u16s, &given, &[Some(0.0), Some(32_768.0), None]);
    let i16s = row(at, "i16.tif", raster(), &[-32_768_i16, -32_767, 8848]);
    check("Int16", i16s, &given, &[None, Some(-32_767.0), Some(8848.0)]);
    let u32s = row(at, "u32.tif", raster(), &[0_u32, 8848, u32::MAX]);
    check("UInt32", u32s, &given, &[Some(0.0), Some(8848.0), None]);
    let i32s = row(at, "i32.tif", raster().nodata(-9999.0), &[i32::MIN, -9999, -11_034]);
    check("Int32", i32s, &given, &[None, None, Some(-11_034.0)]);
    let u64s = raster().tagged(|dataset| {
        dataset.rasterband(1).unwrap().set_no_data_value_u64(Some(77)).unwrap();
    });
    check("UInt64", row(at, "u64.tif", u64s, &[77_u64, 78]), &given, &[None, Some(78.0)]);
    let i64s = raster().tagged(|dataset| {
        dataset.rasterband(1).unwrap().set_no_data_value_i64(Some(-9999)).unwrap();
    });
    check("Int64", row(at, "i64.tif", i64s, &[-9999_i64, -78]), &given, &[None, Some(-78.0)]);
    let f64s = row(at, "f64.tif", raster(), &[0.1_f64, -1e-300, 8848.86]);
    check("Float64", f64s, &given, &[Some(0.1), Some(-1e-300), Some(8848.86)]);
}

#[test]
fn complex_samples_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for kind in ["CInt16", "CInt32", "CFloat32", "CFloat64"] {
        let path = folder.path().join(format!("{kind}.vrt"));
        let text = format!(
            "<VRTDataset rasterXSize=\"6\" rasterYSize=\"5\"><SRS>EPSG:32632</SRS><GeoTransform>\
             500000, 10, 0, 5200000, 0, -10</GeoTransform><VRTRasterBand dataType=\"{kind}\" band=\"1\"/>\
             </VRTDataset>"
        );
        fs::write(&path, text).unwrap();
        check_refused(&[path], &OpenOptions::default(), &[kind, "complex", "cannot be heights"]);
    }
}

/// Huge values are not heights, with a nodata tag or without; a tag matches only its own value, in
/// the file's own precision.
#[test]
fn huge_values_and_sentinels_are_void() {
    let folder = tempfile::tempdir().unwrap();
    let (at, given) = (folder.path(), OpenOptions::default());
    let huge = [
        7.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        1e38,
        -1e38,
        f32::MAX,
        f32::MIN,
        1e20,
        -1e20,
        9.969_21e36,
    ];
    let mut expected = vec![None; huge.len()];
    expected[0] = Some(7.0);
    for (name, nodata) in [
        ("untagged", None),
        ("nan", Some(f64::NAN)),
        ("max", Some(3.402_823_466_385_288_6e38)),
        ("digits", Some(-3.4e38)),
        ("other", Some(-9999.0)),
    ] {
        let tagged = Raster { nodata, ..raster() };
        check(name, row(at, &format!("{name}.tif"), tagged, &huge), &given, &expected);
    }
    let values = [-9999.9_f32, -9999.0, 0.0, 4e-27];
    let tagged = row(at, "precise.tif", raster().nodata(-9999.9), &values);
    check("precise", tagged.clone(), &given, &[None, Some(-9999.0), Some(0.0), Some(4e-27)]);
    let more = OpenOptions { nodata: vec![0.0], ..given };
    check("--nodata", tagged, &more, &[None, Some(-9999.0), None, Some(4e-27)]);
}

/// Scale and offset before the unit; sentinels before either. Ratios of feet to their last bit.
#[test]
fn units_scale_and_offset_make_metres() {
    let folder = tempfile::tempdir().unwrap();
    let given = OpenOptions::default();
    let survey_m = 1200.0 / 3937.0;
    for (unit, unit_m) in [
        ("", 1.0),
        ("m", 1.0),
        ("metre", 1.0),
        ("ft", 0.3048),
        ("foot", 0.3048),
        ("US survey foot", survey_m),
        ("us-ft", survey_m),
        ("cm", 0.01),
        ("dm", 0.1),
        ("km", 1000.0),
    ] {
        let name = format!("{}.tif", unit.replace(' ', "-"));
        let scaled = raster().nodata(-9999.0).tagged(|dataset| {
            let mut band = dataset.rasterband(1).unwrap();
            band.set_scale(0.25).unwrap();
            band.set_offset(100.0).unwrap();
        });
        let path = row(folder.path(), &name, scaled, &[0_i16, 7, -9999, -400]);
        // The crate `gdal` cannot set a band's unit; a sidecar of GDAL's own can.
        let aux = format!(
            "<PAMDataset><PAMRasterBand band=\"1\"><UnitType>{unit}</UnitType></PAMRasterBand></PAMDataset>"
        );
        fs::write(folder.path().join(format!("{name}.aux.xml")), aux).unwrap();
        let expected = [Some(100.0 * unit_m), Some(101.75 * unit_m), None, Some(0.0)];
        check(unit, path, &given, &expected);
    }
    // A unit that is not a length, or the wrong one, is replaced by an option.
    for unit in ["masl", "unspecified", "m a.s.l.", "feet above sea", "ft"] {
        let path = row(folder.path(), "said.tif", raster(), &[1_i16, 2]);
        let aux = format!(
            "<PAMDataset><PAMRasterBand band=\"1\"><UnitType>{unit}</UnitType></PAMRasterBand></PAMDataset>"
        );
        fs::write(folder.path().join("said.tif.aux.xml"), aux).unwrap();
        if unit != "ft" {
            check_refused(
                std::slice::from_ref(&path),
                &given,
                &["said.tif", unit, "--vertical-unit"],
            );
        }
        for (said, unit_m) in [("metre", 1.0), ("us-foot", survey_m), ("decimetre", 0.1)] {
            let given = OpenOptions { vertical_unit: Some(said.to_owned()), ..given.clone() };
            check(unit, path.clone(), &given, &[Some(unit_m), Some(2.0 * unit_m)]);
        }
    }
    let odd = OpenOptions { vertical_unit: Some("masl".to_owned()), ..given.clone() };
    let path = row(folder.path(), "odd.tif", raster(), &[1_i16, 2]);
    check_refused(&[path], &odd, &["--vertical-unit", "masl", "us-foot"]);
    let path = row(folder.path(), "fathoms.tif", raster(), &[1_i16, 2]);
    let aux = "<PAMDataset><PAMRasterBand band=\"1\"><UnitType>fathom</UnitType></PAMRasterBand></PAMDataset>";
    fs::write(folder.path().join("fathoms.tif.aux.xml"), aux).unwrap();
    check_refused(&[path], &given, &["fathoms.tif", "fathom", "--vertical-unit metre"]);
    let flat = raster().tagged(|dataset| dataset.rasterband(1).unwrap().set_scale(0.0).unwrap());
    check_refused(
        &[row(folder.path(), "flat.tif", flat, &[1_i16, 2])],
        &given,
        &["flat.tif", "scale 0"],
    );
}

/// A mask inside or next to the file, or an alpha band, removes samples, whatever their values are.
#[test]
fn masks_take_samples_away() {
    let folder = tempfile::tempdir().unwrap();
    let given = OpenOptions::default();
    for (name, is_internal) in [("internal", "YES"), ("sidecar", "NO")] {
        gdal::config::set_thread_local_config_option("GDAL_TIFF_INTERNAL_MASK", is_internal)
            .unwrap();
        let masked = Raster { size: [3, 5], ..raster() }.tagged(|dataset| {
            let mut band = dataset.rasterband(1).unwrap();
            band.create_mask_band(true).unwrap();
            let valid = [255_u8, 0, 255].repeat(5);
            band.open_mask_band()
                .unwrap()
                .write((0, 0), (3, 5), &mut Buffer::new((3, 5), valid))
                .unwrap();
        });
        let path = row(folder.path(), &format!("{name}.tif"), masked, &[5_i16, 6, 7]);
        let sidecar = folder.path().join(format!("{name}.tif.msk"));
        assert_eq!(sidecar.exists(), is_internal == "NO");
        check(name, path, &given, &[Some(5.0), None, Some(7.0)]);
    }
    gdal::config::clear_thread_local_config_option("GDAL_TIFF_INTERNAL_MASK").unwrap();
    alpha(folder.path(), "u8.tif", [5_u8, 6, 7], [255, 1, 0]);
    alpha(folder.path(), "u16.tif", [5_u16, 6, 7], [65_535, 1, 0]);
    // For other types GDAL creates no mask; its own warper writes such files.
    alpha(folder.path(), "i16.tif", [5_i16, 6, 7], [32_767, 1, 0]);
    alpha(folder.path(), "f32.tif", [5.0_f32, 6.0, 7.0], [255.0, 1.0, 0.0]);
}

/// `gdal_translate -mo NODATA_VALUES=…` declares a sentinel for the dataset, with or without one of
/// the band's own.
#[test]
fn a_sentinel_of_the_whole_dataset_is_one_too() {
    let folder = tempfile::tempdir().unwrap();
    for (name, nodata, last) in [("alone", None, Some(7.0)), ("both", Some(7.0), None)] {
        let declared = Raster { nodata, ..raster() }.tagged(|dataset| {
            dataset.set_metadata_item("NODATA_VALUES", "-9999", "").unwrap();
        });
        let path = row(folder.path(), &format!("{name}.tif"), declared, &[5_i16, -9999, 7]);
        check(name, path, &OpenOptions::default(), &[Some(5.0), None, last]);
        let declared = Raster { nodata, ..raster() }.tagged(|dataset| {
            dataset.set_metadata_item("NODATA_VALUES", "-9999.9", "").unwrap();
        });
        let path = row(folder.path(), &format!("{name}-f32.tif"), declared, &[5_f32, -9999.9, 7.0]);
        check(name, path, &OpenOptions::default(), &[Some(5.0), None, last]);
    }
}

/// The last of three samples is transparent, and so is the second once it is also nodata.
fn alpha<T: GdalType + Copy>(folder: &Path, name: &str, values: [T; 3], opacity: [T; 3]) {
    for nodata in [None, Some(6.0)] {
        let raster = Raster { size: [3, 5], nodata, ..raster() };
        let raster = raster.bands(2).created(&["ALPHA=YES"]).tagged(|dataset| {
            let mut band = dataset.rasterband(2).unwrap();
            assert_eq!(band.color_interpretation(), ColorInterpretation::AlphaBand);
            let mut opacity = Buffer::new((3, 5), opacity.repeat(5));
            band.write((0, 0), (3, 5), &mut opacity).unwrap();
        });
        let path = row(folder, &format!("{nodata:?}-{name}"), raster, &values);
        let second = if nodata.is_some() { None } else { Some(6.0) };
        check(name, path, &OpenOptions::default(), &[Some(5.0), second, None]);
    }
}

#[test]
fn the_only_band_counts_and_of_several_the_one_that_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let given = OpenOptions::default();
    let named = raster().bands(2).tagged(|dataset| {
        dataset.rasterband(1).unwrap().set_description("height").unwrap();
    });
    let two = row(folder.path(), "two.tif", named, &[5_i16, 6]);
    let words = ["two.tif", "1 \"height\"", "2 (no name, Int16)", "--dem-band"];
    check_refused(std::slice::from_ref(&two), &given, &words);
    for (band, heights_m) in [(1, [Some(5.0), Some(6.0)]), (2, [Some(0.0), Some(0.0)])] {
        let chosen = OpenOptions { band: Some(band), ..given.clone() };
        check("two bands", two.clone(), &chosen, &heights_m);
    }
    let missing = OpenOptions { band: Some(3), ..given.clone() };
    check_refused(&[two], &missing, &["two.tif", "2 bands", "--dem-band"]);
    // In files with one band, as in a set of files, this band counts for any choice; an alpha band
    // has no heights.
    let one = row(folder.path(), "one.tif", raster(), &[5_i16, 6]);
    let with_alpha = raster().bands(2).created(&["ALPHA=YES"]).tagged(|dataset| {
        let mut opaque = Buffer::new((2, 5), vec![255_u8; 10]);
        dataset.rasterband(2).unwrap().write((0, 0), (2, 5), &mut opaque).unwrap();
    });
    let with_alpha = row(folder.path(), "alpha.tif", with_alpha, &[5_u8, 6]);
    let second = OpenOptions { band: Some(2), ..given.clone() };
    for path in [&one, &with_alpha] {
        check("one band", path.clone(), &second, &[Some(5.0), Some(6.0)]);
    }
    let none = OpenOptions { band: Some(0), ..given.clone() };
    check_refused(&[one], &none, &["one.tif", "--dem-band is 0"]);
    let palette = raster().tagged(|dataset| {
        let mut table = ColorTable::new(PaletteInterpretation::Rgba);
        table.set_color_entry(5, &ColorEntry::rgba(255, 0, 0, 255));
        dataset.rasterband(1).unwrap().set_color_table(&table);
    });
    check(
        "palette",
        row(folder.path(), "p.tif", palette, &[5_u8, 6]),
        &given,
        &[Some(5.0), Some(6.0)],
    );
    let photo = raster().bands(3).created(&["PHOTOMETRIC=RGB"]);
    check_refused(
        &[row(folder.path(), "photo.tif", photo, &[5_u8, 6])],
        &given,
        &["photo.tif", "image", "red", "--dem-band"],
    );
}

/// A virtual raster can have a band of each type: the metadata used are those of the chosen band.
#[test]
fn what_is_wrong_with_a_band_is_told_with_its_number() {
    let folder = tempfile::tempdir().unwrap();
    let second = OpenOptions { band: Some(2), ..OpenOptions::default() };
    for (name, kind, inside, word) in [
        ("complex.vrt", "CFloat32", "", "complex numbers"),
        ("flat.vrt", "Float32", "<Scale>0</Scale>", "scale 0"),
    ] {
        let path = folder.path().join(name);
        let vrt = format!(
            "<VRTDataset rasterXSize=\"3\" rasterYSize=\"5\"><SRS>EPSG:32632</SRS><GeoTransform>500000,10,0,5200050,0,-10</GeoTransform>\
             <VRTRasterBand dataType=\"Float32\" band=\"1\"/><VRTRasterBand dataType=\"{kind}\" band=\"2\">{inside}</VRTRasterBand></VRTDataset>"
        );
        fs::write(&path, vrt).unwrap();
        check_refused(&[path], &second, &["band 2 of", name, word]);
    }
}

/// Heights keep their own unit if the plan is in feet.
#[test]
fn feet_on_the_ground_are_not_feet_of_height() {
    let folder = tempfile::tempdir().unwrap();
    let frame = [2_690_000.0, 30.0, 0.0, 235_000.0, 0.0, -30.0];
    let foot_m = 1200.0 / 3937.0;
    let truth = |[x, y]: [f64; 2]| (x - 2_690_000.0 + 2.0 * (y - 234_000.0)) / 10.0;
    let metres = Raster::new(2272, [40, 30], frame).write(folder.path(), "metres.tif", truth);
    let plain = |[x, y]: [f64; 2]| truth([x / foot_m, y / foot_m]);
    let given = OpenOptions::default();
    let count = check_heights("metres", &[metres], &given, (Space::Working, 1e-3), plain);
    assert_eq!(count, 1200);
}

#[test]
fn lone_heights_stay_where_all_else_is_void() {
    let folder = tempfile::tempdir().unwrap();
    let path = row(folder.path(), "void.tif", raster().nodata(0.0), &[0_i16, 0, 0]);
    let dem = open(&[path]);
    let plan = plan(&dem);
    let heights = dem.reader(&plan).window(all(&plan)).unwrap().heights;
    assert_eq!(heights.count_heights(), 0);
}
