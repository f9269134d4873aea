//! Heights converted between vertical systems: a geoid that is a plane, feet, depths, and missing
//! grids.

use std::fs;
use std::path::{Path, PathBuf};

use corniche_dem::{Dem, HeightDatumError, OpenDemError, OpenOptions, PlanOptions};
use corniche_geom::{Cell, NodeIndex, NodeWindow, Projection};
use gdal::DriverManager;
use gdal::raster::Buffer;
use gdal::spatial_ref::SpatialRef;

use crate::fixture::{
    Raster, Space, UTM, all, check, check_heights, check_refused, open, options, plan, plane,
    sample_blocks,
};

const MILLIMETRE: f64 = 1e-3;

/// Height of the geoid over the ellipsoid, metres: linear, so that PROJ's bilinear interpolation is
/// exact, up to the grid's 32-bit values.
fn undulation_m([lon, lat]: [f64; 2]) -> f64 {
    40.0 + 20.0 * (lon - 9.0) - 30.0 * (lat - 47.0)
}

/// Writes that geoid for 8..10° E, 46..48° N, and returns the vertical CRS above it.
fn geoid(folder: &Path) -> String {
    raised_geoid(folder, 0.0)
}

/// The same geoid, raised by some metres.
fn raised_geoid(folder: &Path, by_m: f64) -> String {
    let path = folder.join("geoid.gtx");
    let driver = DriverManager::get_driver_by_name("GTX").unwrap();
    let mut grid = driver.create_with_band_type::<f32, _>(&path, 21, 21, 1).unwrap();
    grid.set_geo_transform(&[7.95, 0.1, 0.0, 48.05, 0.0, -0.1]).unwrap();
    let values = (0..441)
        .map(|k| {
            let at = [8.0 + f64::from(k % 21) / 10.0, 48.0 - f64::from(k / 21) / 10.0];
            (undulation_m(at) + by_m) as f32
        })
        .collect();
    let mut band = grid.rasterband(1).unwrap();
    band.write((0, 0), (21, 21), &mut Buffer::new((21, 21), values)).unwrap();
    above(&path)
}

/// WKT2 of heights above the geoid of a grid.
fn above(grid: &Path) -> String {
    format!(
        r#"BOUNDCRS[SOURCECRS[VERTCRS["local height",VDATUM["local geoid"],CS[vertical,1],
        AXIS["gravity-related height (H)",up,LENGTHUNIT["metre",1]]]],
        TARGETCRS[GEOGCRS["WGS 84",DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,298.257223563]],
        CS[ellipsoidal,3],AXIS["latitude",north,ORDER[1],ANGLEUNIT["degree",0.0174532925199433]],
        AXIS["longitude",east,ORDER[2],ANGLEUNIT["degree",0.0174532925199433]],
        AXIS["ellipsoidal height",up,ORDER[3],LENGTHUNIT["metre",1]],ID["EPSG",4979]]],
        ABRIDGEDTRANSFORMATION["to ellipsoidal height",METHOD["GravityRelatedHeight to Geographic3D"],
        PARAMETERFILE["Geoid (height correction) model file","{}"]]]"#,
        grid.display()
    )
}

pub(crate) fn given(own: &str, wanted: &str) -> OpenOptions {
    let text = |text: &str| (!text.is_empty()).then(|| text.to_owned());
    OpenOptions {
        dem_vertical_crs: text(own),
        vertical_crs: text(wanted),
        ..OpenOptions::default()
    }
}

/// A raster whose CRS is a compound one.
fn compound(definition: &str) -> Raster<'_> {
    Raster::new(0, [60, 50], UTM).tagged(move |dataset| {
        dataset.set_spatial_ref(&SpatialRef::from_definition(definition).unwrap()).unwrap();
    })
}

pub(crate) fn vertical(files: &[PathBuf], options: &OpenOptions) -> (Option<String>, String) {
    let plan = plan(&Dem::open(files, options).unwrap());
    (plan.vertical_datum, plan.vertical)
}

#[test]
fn a_plane_of_a_geoid_shifts_heights_to_the_millimetre() {
    let folder = tempfile::tempdir().unwrap();
    let local = geoid(folder.path());
    let utm = [Raster::new(32632, [60, 50], UTM).write(folder.path(), "utm.tif", plane)];
    let probe = open(&utm);
    let probe_plan = plan(&probe);
    let projection = probe.projection(&probe_plan).unwrap();
    let undulation_at = |at: [f64; 2]| {
        let mut points = [at];
        projection.wgs84_from_working(&mut points).unwrap();
        undulation_m(points[0])
    };
    let frame = [8.9, 0.0002, 0.0, 46.98, 0.0, -0.00015];
    let rise = |[lon, lat]: [f64; 2]| 800.0 + 3000.0 * (lon - 8.9) + 1000.0 * (lat - 46.9);
    let degrees = [Raster::new(4326, [300, 250], frame).write(folder.path(), "ll.tif", rise)];
    for (from, to, sign) in [(local.as_str(), "EPSG:4979", 1.0), ("EPSG:4979", &local, -1.0)] {
        let options = given(from, to);
        let truth = |at: [f64; 2]| plane(at) + sign * undulation_at(at);
        let count = check_heights(to, &utm, &options, (Space::Working, MILLIMETRE), truth);
        assert_eq!(count, 3000, "{to}");
        // Also where nodes lie between samples: position errors of 1/100 cell are 2 cm on this
        // slope.
        let truth = |at: [f64; 2]| rise(at) + sign * undulation_m(at);
        let count = check_heights(to, &degrees, &options, (Space::Degrees, 0.025), truth);
        assert!(count > 70_000, "{count}");
        let (datum, words) = vertical(&utm, &options);
        let (datum, has_path) = (datum.unwrap(), words.contains(&*folder.path().to_string_lossy()));
        assert!(words.contains("geoid.gtx") && !has_path, "{words}");
        assert_eq!(datum.contains("ellipsoidal"), to == "EPSG:4979", "{datum}");
    }
    // There and back again, through a file that names its own vertical CRS.
    let back = OpenOptions { vertical_shift_m: 1.5, ..given(&local, &local) };
    let count =
        check_heights("back", &utm, &back, (Space::Working, MILLIMETRE), |at| plane(at) + 1.5);
    assert_eq!(count, 3000);
    assert!(vertical(&utm, &back).1.ends_with(", then +1.5 m"));
}

/// The bits are the same in any window, also at the rim of the grid, and for original samples.
#[test]
fn the_offset_of_a_node_does_not_depend_on_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let options_ =
        OpenOptions { vertical_shift_m: -7.25, ..given(&geoid(folder.path()), "EPSG:4979") };
    let frame = [8.5, 0.001, 0.0, 47.5, 0.0, -0.001];
    let file = Raster::new(4326, [300, 250], frame).nodata(0.0).write(
        folder.path(),
        "ll.tif",
        |[lon, lat]| {
            if (lon * 70.0).sin() * (lat * 90.0).cos() > 0.6 {
                0.0
            } else {
                lon * 100.0 - lat * 10.0
            }
        },
    );
    let dem = Dem::open(&[file], &options_).unwrap();
    for cell_m in [None, Some(240.0)] {
        let plan = dem
            .plan(&PlanOptions { cell: cell_m.map(Cell::from), fill_voids: 5, ..options() })
            .unwrap();
        let whole = all(&plan);
        let reference = dem.reader(&plan).window(whole).unwrap().heights;
        let mut reader = dem.reader(&plan);
        for (left, top, columns, rows) in
            [(0, 0, 40, 40), (13, 7, 33, 61), (50, 40, 1, 1), (60, 55, 20, 30)]
        {
            let corner = NodeIndex { i: whole.corner.i + left, j: whole.corner.j - top };
            let window = NodeWindow { corner, stride: 1, columns, rows };
            let seen = reader.window(window).unwrap().heights;
            for row in 0..rows {
                for column in 0..columns {
                    let same = reference.height(left as usize + column, top as usize + row);
                    assert_eq!(seen.height(column, row).map(f32::to_bits), same.map(f32::to_bits));
                }
            }
        }
    }
    let plan = plan(&dem);
    let projection = dem.projection(&plan).unwrap();
    let mut count = 0;
    let each = |block: &corniche_dem::SampleBlock| {
        let mut points = block.positions_m.clone();
        projection.wgs84_from_working(&mut points).unwrap();
        for (&at, &height_m) in points.iter().zip(&block.heights_m) {
            let truth_m = at[0] * 100.0 - at[1] * 10.0 + undulation_m(at) - 7.25;
            assert!(
                (f64::from(height_m) - truth_m).abs() < MILLIMETRE,
                "{height_m}, not {truth_m}"
            );
            count += 1;
        }
    };
    sample_blocks(&dem, &plan).iter().for_each(each);
    assert!(count > 50_000, "{count}");
}

/// Feet and depths of one datum only need factors: no grid is used.
#[test]
fn units_and_directions_are_turned_without_a_grid() {
    let folder = tempfile::tempdir().unwrap();
    let survey_m = 1200.0 / 3937.0;
    for (own, m_per_value, name) in [
        ("EPSG:32632+5703", 1.0, "NAVD88 height"),
        ("EPSG:32632+6360", survey_m, "North American Vertical Datum 1988"),
        ("EPSG:32632+8228", 0.3048, "North American Vertical Datum 1988"),
        ("EPSG:32632+6357", -1.0, "North American Vertical Datum 1988"),
        ("EPSG:32632+6358", -survey_m, "North American Vertical Datum 1988"),
        ("EPSG:32632+5715", -1.0, "Mean Sea Level"),
    ] {
        let file = [compound(own).write(folder.path(), &format!("{}.tif", &own[11..]), plane)];
        let plain = OpenOptions::default();
        let truth = |at: [f64; 2]| plane(at) * m_per_value;
        let count = check_heights(own, &file, &plain, (Space::Working, MILLIMETRE), truth);
        assert_eq!(count, 3000);
        assert_eq!(vertical(&file, &plain).0.as_deref(), Some(name), "{own}");
        assert_eq!(vertical(&file, &plain).1.contains("depths"), m_per_value < 0.0, "{own}");
        // The same unit given by an option, and another target unit: heights are in metres
        // nevertheless.
        let bare = [Raster::new(32632, [60, 50], UTM).write(folder.path(), "bare.tif", plane)];
        let wanted = if own.ends_with("5715") { "EPSG:5714" } else { "EPSG:6360" };
        let named = given(&format!("EPSG:{}", &own[11..]), wanted);
        let count = check_heights(own, &bare, &named, (Space::Working, MILLIMETRE), truth);
        assert_eq!(count, 3000);
    }
}

#[test]
fn a_band_whose_unit_contradicts_its_vertical_system_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = compound("EPSG:32632+6360").write(folder.path(), "both.tif", plane);
    let aux = |unit: &str| {
        let text = format!(
            "<PAMDataset><PAMRasterBand band=\"1\"><UnitType>{unit}</UnitType></PAMRasterBand></PAMDataset>"
        );
        fs::write(folder.path().join("both.tif.aux.xml"), text).unwrap();
    };
    aux("metre");
    let words = ["both.tif", "\"metre\"", "NAVD88 height (ftUS)"];
    check_refused(std::slice::from_ref(&path), &OpenOptions::default(), &words);
    // The unit of the option counts, and the direction (up or down) of the system stays.
    for (system, unit, m_per_value) in
        [("EPSG:32632+6360", "metre", 1.0), ("EPSG:32632+6358", "decimetre", -0.1)]
    {
        let path = compound(system).write(folder.path(), "both.tif", plane);
        let said = OpenOptions { vertical_unit: Some(unit.to_owned()), ..OpenOptions::default() };
        let truth = |at: [f64; 2]| plane(at) * m_per_value;
        check_heights(unit, &[path], &said, (Space::Working, MILLIMETRE), truth);
    }
    let path = compound("EPSG:32632+6360").write(folder.path(), "both.tif", plane);
    aux("ft");
    let truth = |at: [f64; 2]| plane(at) * 1200.0 / 3937.0;
    let given = OpenOptions::default();
    check_heights("ft", &[path], &given, (Space::Working, MILLIMETRE), truth);
}

#[test]
fn what_is_missing_is_named_and_never_guessed() {
    let folder = tempfile::tempdir().unwrap();
    let local = geoid(folder.path());
    let utm = [Raster::new(32632, [60, 50], UTM).write(folder.path(), "utm.tif", plane)];
    let gone = above(&folder.path().join("gone.gtx"));
    check_refused(&utm, &given("EPSG:4979", &gone), &["utm.tif", "gone.gtx", "--vertical-shift"]);
    let words = ["utm.tif", "the geoid grid", "gone.gtx", "install"];
    check_refused(&utm, &given(&gone, "EPSG:4979"), &words);
    let optional = gone.replace("model file\",\"", "model file\",\"@");
    check_refused(&utm, &given("EPSG:4979", &optional), &["gone.gtx", "optional"]);
    // Two geoids between which PROJ knows no operation, and would leave heights unchanged.
    let words = ["utm.tif", "Baltic 1977 height", "NAVD88 height", "no exact", "may be missing"];
    check_refused(&utm, &given("EPSG:5705", "EPSG:5703"), &words);
    // A file that exists but is not a grid: the message must not claim that it is missing.
    fs::write(folder.path().join("text.gtx"), "no grid").unwrap();
    let broken = above(&folder.path().join("text.gtx"));
    let words = ["utm.tif", "no exact", "may be missing (", "text.gtx"];
    check_refused(&utm, &given("EPSG:4979", &broken), &words);
    check_refused(
        &utm,
        &given("", "EPSG:5773"),
        &["utm.tif", "EGM96 height", "--dem-vertical-crs"],
    );
    for text in ["EPSG:32632", "EPSG:4326", "Atlantis", "EPSG:999999"] {
        check_refused(&utm, &given("EPSG:5773", text), &["--vertical-crs", text, "EPSG:n"]);
        check_refused(&utm, &given(text, ""), &["--dem-vertical-crs", text, "EPSG:n"]);
    }
    for shift_m in [f64::NAN, f64::INFINITY, -1e6] {
        let shifted = OpenOptions { vertical_shift_m: shift_m, ..OpenOptions::default() };
        check_refused(&utm, &shifted, &["--vertical-shift", "metres"]);
    }
    // Data beyond the grid's rim, which is at 10° E.
    let frame = [9.9, 0.001, 0.0, 47.0, 0.0, -0.001];
    let wide =
        [Raster::new(4326, [200, 50], frame).write(folder.path(), "wide.tif", |_| 100.0_f32)];
    check_refused(&wide, &given(&local, "EPSG:4979"), &["wide.tif", "column", "outside"]);
    // Voids there do not matter.
    let east = |[lon, _]: [f64; 2]| if lon > 9.99 { f32::NAN } else { 100.0 };
    let void = [Raster::new(4326, [200, 50], frame).write(folder.path(), "void.tif", east)];
    let truth = |at: [f64; 2]| 100.0 + undulation_m(at);
    let options = given(&local, "EPSG:4979");
    let count = check_heights("void", &void, &options, (Space::Degrees, MILLIMETRE), truth);
    assert!(count > 3000, "{count}");
}

#[test]
fn files_must_agree_on_what_heights_are_measured_from() {
    let folder = tempfile::tempdir().unwrap();
    let local = geoid(folder.path());
    let half = |name: &str, definition: &'static str, column: f64| {
        let frame = [UTM[0] + 10.0 * column, 10.0, 0.0, UTM[3], 0.0, -10.0];
        Raster { geo_transform: frame, size: [30, 50], ..compound(definition) }.write(
            folder.path(),
            name,
            plane,
        )
    };
    let navd88 = half("navd88.tif", "EPSG:32632+5703", 0.0);
    let feet = half("feet.tif", "EPSG:32632+6360", 30.0);
    let bare = half("bare.tif", "EPSG:32632", 30.0);
    let egm96 = half("egm96.tif", "EPSG:32632+5773", 30.0);
    let plain = OpenOptions::default();
    let both = |a: &PathBuf, b: &PathBuf| [a.clone(), b.clone()];
    let words = ["navd88.tif", "bare.tif", "NAVD88", "no named", "--dem-vertical-crs"];
    check_refused(&both(&navd88, &bare), &plain, &words);
    let words = ["navd88.tif", "egm96.tif", "NAVD88", "EGM96", "--vertical-crs"];
    check_refused(&both(&egm96, &navd88), &plain, &words);
    // Feet and metres of one datum agree.
    let (datum, words) = vertical(&both(&navd88, &feet), &plain);
    assert_eq!(datum.as_deref(), Some("North American Vertical Datum 1988"));
    assert_eq!(words, "as in the files");
    // Files without a vertical CRS get one by --dem-vertical-crs.
    let count = check_heights(
        "given",
        &both(&navd88, &bare),
        &given("EPSG:5703", ""),
        (Space::Working, MILLIMETRE),
        plane,
    );
    assert_eq!(count, 3000);
    // Several datums, one target: each file has its own operation.
    let ellipsoidal = half("ellipsoidal.tif", "EPSG:32632", 0.0);
    let carried = [ellipsoidal, egm96];
    let options_ = given(&local, "EPSG:4979");
    match Dem::open(&carried, &options_) {
        Ok(dem) => {
            assert!(dem.plan(&options()).unwrap().vertical.contains("; "));
            let plan = plan(&dem);
            let heights = dem.reader(&plan).window(all(&plan)).unwrap().heights;
            // EGM96's undulation here is 47.6 to 48.0 m, the plane's about 40 to 42.
            for (column, [low, high]) in [(0, [39.0, 43.0]), (59, [47.0, 49.0])] {
                let node = all(&plan).node(column, 25);
                let own = plane([plan.frame.x_m(node.i), plan.frame.y_m(node.j)]);
                let offset = f64::from(heights.height(column, 25).unwrap()) - own;
                assert!((low..high).contains(&offset), "{offset}");
            }
        }
        Err(error) => {
            let OpenDemError::Datum(cause) = &error else { panic!("{error}") };
            assert!(matches!(**cause, HeightDatumError::VerticalOperation { .. }), "{error}");
            corniche_testing::skip(&format!("PROJ has no grid of EGM96 here: {error}"));
        }
    }
}

/// Two editions of a grid under one name: the descriptions of the conversion differ, because PROJ
/// does not say which grid it used.
#[test]
fn different_grids_are_told_apart_by_the_offset_on_record() {
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let utm = [Raster::new(32632, [60, 50], UTM).write(folders[0].path(), "utm.tif", plane)];
    // The middle of 600 m × 500 m is at 500 303, 5 200 257 in UTM, by `gdaltransform` at:
    let middle_m = undulation_m([9.003_982_22, 46.955_841_83]);
    let offset_m = |words: &str| -> f64 {
        let (before, _) = words.split_once(" m at the centre").unwrap();
        before.rsplit(' ').next().unwrap().parse().unwrap()
    };
    for (folder, by_m) in folders.iter().zip([0.0, 1.0]) {
        let local = raised_geoid(folder.path(), by_m);
        for (from, to, sign) in [(local.as_str(), "EPSG:4979", 1.0), ("EPSG:4979", &local, -1.0)] {
            let words = vertical(&utm, &given(from, to)).1;
            let found_m = offset_m(&words);
            assert!((found_m - sign * (middle_m + by_m)).abs() < 0.0015, "{middle_m}: {words}");
        }
    }
    // Files in different systems of the plan with the same conversion: one text for all.
    let local = geoid(folders[0].path());
    let frame = [9.02, 0.0002, 0.0, 46.96, 0.0, -0.00015];
    let beside = Raster::new(4326, [30, 25], frame).write(folders[0].path(), "ll.tif", plane);
    let words = vertical(&[utm[0].clone(), beside], &given(&local, "EPSG:4979")).1;
    assert_eq!(words.matches("carried").count(), 1, "{words}");
    assert!(words.ends_with(" m at the centre"), "{words}");
    // The centre lies beyond the grid: the first sample whose height can be converted replaces the
    // centre.
    let frame = [9.9, 0.001, 0.0, 47.0, 0.0, -0.001];
    let east = |[lon, _]: [f64; 2]| if lon > 9.99 { f32::NAN } else { 100.0 };
    let half = [Raster::new(4326, [300, 50], frame).write(folders[0].path(), "half.tif", east)];
    let words = vertical(&half, &given(&local, "EPSG:4979")).1;
    assert!(words.ends_with(" m at 9.93, 46.995 in EPSG:4326"), "{words}");
}

#[test]
fn no_vertical_options_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let dem = open(&[Raster::new(32632, [60, 50], UTM).write(folder.path(), "utm.tif", plane)]);
    let plan = plan(&dem);
    assert_eq!((plan.vertical_datum.clone(), plan.vertical.as_str()), (None, "as in the files"));
    assert_eq!(check(&mut dem.reader(&plan), &plan, 1e-4, plane), 3000);
}
