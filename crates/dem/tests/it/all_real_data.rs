//! Every elevation file of the real data is read as by GDAL, or rejected as its description says.

use std::path::{Path, PathBuf};

use corniche_dem::{Dem, OpenOptions, Resampling};
use gdal::Dataset;

use crate::fixture::{all, check_refused, plan, sample_blocks};
use crate::real_data::data;

/// The values of GDAL in the first band; void for `sentinel` or GDAL's own nodata value.
fn stored(path: &Path, sentinel: Option<f64>) -> (usize, Vec<Option<f64>>) {
    let dataset = Dataset::open(path).unwrap();
    let band = dataset.rasterband(1).unwrap();
    let values = band.read_as::<f64>((0, 0), band.size(), band.size(), None).unwrap();
    let is_void = |value: f64| {
        let is = |void: Option<f64>| {
            void.is_some_and(|void| value == void || value as f32 == void as f32)
        };
        value.is_nan() || is(band.no_data_value()) || is(sentinel)
    };
    (band.size().0, values.data().iter().map(|&value| (!is_void(value)).then_some(value)).collect())
}

struct Case {
    name: &'static str,
    dem_crs: Option<&'static str>,
    nodata: Option<f64>,
    unit_m: f64,
    expected: Resampling,
}

const fn plain(name: &'static str, expected: Resampling) -> Case {
    Case { name, dem_crs: None, nodata: None, unit_m: 1.0, expected }
}

/// Aligned: every node is GDAL's sample. Resampled: the returned samples are GDAL's, one for one.
fn check(case: &Case) -> Option<usize> {
    let files = data(&[case.name])?;
    let options = OpenOptions {
        dem_crs: case.dem_crs.map(str::to_owned),
        nodata: case.nodata.into_iter().collect(),
        ..OpenOptions::default()
    };
    let dem = Dem::open(&files, &options).unwrap_or_else(|error| panic!("{error}"));
    let plan = plan(&dem);
    assert_eq!(plan.resampling, case.expected, "{}", case.name);
    let sentinel = case.nodata.or_else(|| case.name.contains("32768").then_some(-32_768.0));
    let (columns, values) = stored(&files[0], sentinel);
    let height_m = |value: f64| (value * case.unit_m) as f32;
    let count = values.iter().flatten().count();
    let mut reader = dem.reader(&plan);
    if case.expected == Resampling::Aligned {
        let window = all(&plan);
        let heights = reader.window(window).unwrap().heights;
        let is_south_up =
            Dataset::open(&files[0]).unwrap().geo_transform().is_ok_and(|map| map[5] > 0.0);
        assert_eq!(window.columns, columns, "{}", case.name);
        for (k, value) in values.iter().enumerate() {
            let row = if is_south_up { window.rows - 1 - k / columns } else { k / columns };
            assert_eq!(heights.height(k % columns, row), value.map(height_m), "{}: {k}", case.name);
        }
    } else {
        let mut found = Vec::new();
        for block in sample_blocks(&dem, &plan) {
            found.extend_from_slice(&block.heights_m);
        }
        let mut expected: Vec<f32> =
            values.iter().flatten().map(|&value| height_m(value)).collect();
        found.sort_unstable_by(f32::total_cmp);
        expected.sort_unstable_by(f32::total_cmp);
        assert_eq!(found.len(), expected.len(), "{}", case.name);
        assert!(found == expected, "{}: heights differ from those that GDAL reads", case.name);
    }
    Some(count)
}

#[test]
fn every_elevation_file_is_read_as_gdal_reads_it() {
    use Resampling::Aligned;
    let mut samples = 0;
    let derived = |name: &'static str| plain(name, Aligned);
    for case in [
        plain("liechtenstein/N47E009.hgt", Aligned),
        plain("slovenia-1m/TM1_564_146.tif", Aligned),
        plain("tirol-5m/avaMal.tif", Aligned),
        plain("portland/portland-ned.tif", Aligned),
        Case {
            nodata: Some(-32_767.0),
            ..plain("craterlake/craterlake-elev-16bit-30m.tif", Aligned)
        },
        plain("swellendam/srtm_41_19_4326.tif", Aligned),
        plain("registry/aletsch.tif", Aligned),
        Case { dem_crs: Some("EPSG:21781"), ..plain("registry/zh_dem_25.tif", Aligned) },
        plain("nasty/dem/portland-ned-nodata.tif", Aligned),
        plain("nasty/dem/rasterio-float_raster_with_nodata.tif", Aligned),
        plain("nasty/dem/qgis-dem_gaps.tif", Aligned),
        plain("nasty/dem/georef/austrian_capitals_model_tie_points_pixel_is_area.tif", Aligned),
        plain(
            "nasty/dem/georef/austrian_capitals_model_transformation_pixel_is_point.tif",
            Aligned,
        ),
        derived("nasty/derived-dem/south-up.tif"),
        derived("nasty/derived-dem/void-32768-undeclared.tif"),
        derived("nasty/derived-dem/nan-void-no-nodata-tag.tif"),
        Case { unit_m: 0.3048, ..derived("nasty/derived-dem/feet.tif") },
        derived("nasty/derived-dem/2x2.tif"),
        derived("nasty/derived-dem/all-void.tif"),
    ] {
        let Some(count) = check(&case) else { continue };
        samples += count;
    }
    println!("{samples} samples are GDAL's own");
}

/// The squares of the large block, and the zipped one whose northern half is void: each opens, and
/// a window has heights within the range of its description.
#[test]
fn every_srtm_square_opens() {
    let squares = ["N47E007", "N47E008", "N48E007", "N48E008", "N48E009", "N48E010"];
    let mut files: Vec<PathBuf> = squares
        .iter()
        .filter_map(|name| data(&[&format!("srtm3-block/{name}.hgt")]))
        .chain(data(&["liechtenstein/N47E010.hgt"]))
        .chain(data(&["registry/N57E011.hgt"]))
        .flatten()
        .collect();
    if let Some(zip) = data(&["juan-de-fuca-1s/N48W125.hgt.zip"]) {
        files.push(PathBuf::from(format!("/vsizip/{}/N48W125.hgt", zip[0].display())));
    }
    for file in files {
        let dem = Dem::open(std::slice::from_ref(&file), &OpenOptions::default()).unwrap();
        let plan = plan(&dem);
        let whole = all(&plan);
        // South of the middle, where all of them have land.
        let window = corniche_geom::NodeWindow {
            corner: whole.node(whole.columns / 3, whole.rows * 3 / 5),
            stride: 1,
            columns: 300,
            rows: 300,
        };
        let heights = dem.reader(&plan).window(window).unwrap().heights;
        let [low, high] = heights.range_m().unwrap();
        assert!(low >= -13.0 && high <= 3370.0, "{file:?}: {low}..{high}");
        assert!(heights.count_heights() > 60_000, "{file:?}: {}", heights.count_heights());
    }
}

/// Invalid files are rejected with their name and advice.
#[test]
fn bad_files_are_refused_as_described() {
    let given = OpenOptions::default();
    for (name, words) in [
        ("nasty/dem/rasterio-rotated.tif", "--dem-crs"),
        ("nasty/dem/rasterio-float_nan.tif", "--dem-crs"),
        ("nasty/dem/rasterio-all-nodata.tif", "image"),
        ("nasty/dem/rasterio-corrupt.tif", "image"),
        ("nasty/dem/BigTIFF.tif", "image"),
        ("nasty/dem/BigTIFFMotorola.tif", "image"),
        ("nasty/dem/libtiff-test_ifd_loop_to_self.tif", "georeference"),
        ("nasty/derived-dem/1x1.tif", "2 × 2"),
        ("nasty/derived-dem/1x512.tif", "2 × 2"),
        ("nasty/derived-dem/N47E009.hgt", "has 1441207 bytes; whole .hgt files have 2884802"),
        ("nasty/derived-dem/truncated-half.tif", "corrupt"),
        ("nasty/derived-dem/truncated-header-6-bytes.tif", "not a raster"),
        ("nasty/derived-dem/zero-bytes.tif", "0 bytes"),
        ("registry/zh_dem_25.tif", "--dem-crs"),
        ("craterlake/craterlake-imagery-30m.tif", "image"),
        ("liechtenstein/liechtenstein-2013-08-03.osm.pbf", "no raster band"),
    ] {
        let Some(files) = data(&[name]) else { return };
        let file_name = Path::new(name).file_name().unwrap().to_string_lossy().into_owned();
        check_refused(&files, &given, &[&file_name, words]);
    }
}
