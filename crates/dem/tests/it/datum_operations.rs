//! Datum operations are reported, and one datum is never silently treated as another.

use std::path::PathBuf;

use corniche_dem::PlanOptions;
use corniche_geom::{Bounds, Projection};
use corniche_gis::{DatumOperation, RecordedCrs};

use crate::fixture::{Raster, check_words, folder, open, options, plan};

/// The operations of a flat raster of 20 × 20 samples.
fn operations(epsg: u32, [x, y]: [f64; 2], spacing: f64) -> Vec<DatumOperation> {
    let folder = folder();
    let frame = [x, spacing, 0.0, y, 0.0, -spacing];
    let file = Raster::new(epsg, [20, 20], frame).write(folder.path(), "flat.tif", |_| 300.0_f32);
    plan(&open(&[file])).datum_operations
}

#[test]
fn the_datum_of_wgs84_needs_no_operation() {
    for (epsg, corner, spacing) in [
        (4326, [9.0, 47.0], 0.001),
        (32632, [500_000.0, 5_200_000.0], 30.0),
        (3857, [1_000_000.0, 5_900_000.0], 30.0),
    ] {
        assert_eq!(operations(epsg, corner, spacing), [], "{epsg}");
    }
}

/// Accuracies are those of the EPSG registry: ETRS89 to WGS 84 (1), MGI to WGS 84 (3), CH1903+ to
/// WGS 84 (1).
#[test]
fn an_operation_is_told_with_the_accuracy_that_the_registry_has() {
    for (epsg, corner, name, accuracy_m) in [
        (25832, [500_000.0, 5_200_000.0], "ETRS89 to WGS 84 (1)", 1.0),
        (31287, [170_000.0, 350_000.0], "MGI to WGS 84 (3)", 1.5),
        (2056, [2_600_000.0, 1_200_000.0], "CH1903+ to WGS 84 (1)", 1.0),
    ] {
        let found = operations(epsg, corner, 30.0);
        let [only] = found.as_slice() else { panic!("{epsg}: {found:?}") };
        assert!(only.record.operation.starts_with(name), "{found:?}");
        assert_eq!(
            (only.record.from.as_str(), only.record.to.as_str()),
            (&*format!("EPSG:{epsg}"), "EPSG:4326")
        );
        assert_eq!(only.record.accuracy_m, Some(accuracy_m), "{found:?}");
        assert!(!only.record.ballpark && !only.must_be_allowed, "{found:?}");
    }
}

/// Files on several grids, alternating between two systems.
#[test]
fn each_system_of_files_has_its_operations_once() {
    let folder = folder();
    let files = [(32632, 30.0), (25832, 20.0), (25833, 25.0), (25832, 15.0), (25833, 10.0)];
    let files: Vec<PathBuf> = (0..)
        .zip(files)
        .map(|(k, (epsg, spacing))| {
            let x = if epsg == 25833 { 44_000.0 } else { 500_000.0 } + 600.0 * f64::from(k);
            let frame = [x, spacing, 0.0, 5_200_000.0, 0.0, -spacing];
            let name = format!("{k}.tif");
            Raster::new(epsg, [20, 20], frame).write(folder.path(), &name, |_| 300.0_f32)
        })
        .collect();
    let found = plan(&open(&files)).datum_operations;
    let from: Vec<&str> = found.iter().map(|found| found.record.from.as_str()).collect();
    assert_eq!(from, ["EPSG:25832", "EPSG:25833"], "{found:?}");
}

/// NAD27 in Utah: by the registry PROJ is accurate to 2.15 m with the grids of NADCON and HARN,
/// without them to 7 m.
#[test]
fn a_better_operation_whose_grid_is_missing_is_told() {
    let found = operations(26712, [420_000.0, 4_500_000.0], 30.0);
    let [only] = found.as_slice() else { panic!("{found:?}") };
    assert!(only.record.operation.starts_with("NAD27 to WGS 84"), "{found:?}");
    let accuracy_m = only.record.accuracy_m.unwrap();
    match &only.better {
        Some(better) => {
            assert!(better.accuracy_m < accuracy_m && !better.grids.is_empty(), "{found:?}");
            let warning = only.warning().unwrap();
            assert!(
                warning.contains(&better.grids[0]) && warning.contains("projsync"),
                "{warning}"
            );
        }
        None => assert!(accuracy_m < 2.5, "all grids are there: {found:?}"),
    }
}

/// A file in a Gauss-Krüger system of a datum that has only a name: on the ellipsoid of Bessel, or
/// another one.
fn custom(folder: &std::path::Path, datum: &str, [major_m, inverse]: [f64; 2]) -> PathBuf {
    let frame = [4_500_000.0, 30.0, 0.0, 5_400_000.0, 0.0, -30.0];
    let file = Raster::new(31468, [20, 20], frame).write(folder, "custom.tif", |_| 300.0_f32);
    let wkt = format!(
        "PROJCS[\"Custom\",GEOGCS[\"Custom\",DATUM[\"{datum}\",SPHEROID[\"Custom\",{major_m},{inverse}]],\
         PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],\
         PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",12],PARAMETER[\"scale_factor\",1],\
         PARAMETER[\"false_easting\",4500000],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]"
    );
    crate::datums::relabelled(&file, &wkt)
}

const BESSEL: [f64; 2] = [6_377_397.155, 299.152_812_8];
const GRS80: [f64; 2] = [6_378_137.0, 298.257_222_101];

#[test]
fn a_local_datum_is_not_taken_for_wgs84_unless_that_is_allowed() {
    let folder = folder();
    let file = custom(folder.path(), "Local survey", BESSEL);
    let dem = open(std::slice::from_ref(&file));
    for crs in [None, Some("utm")] {
        let asked = PlanOptions { crs: crs.map(str::to_owned), ..options() };
        let plan = dem.plan(&asked).unwrap();
        let found = &plan.datum_operations;
        assert!(
            found.iter().any(|found| found.record.ballpark && found.must_be_allowed),
            "{found:?}"
        );
        let error = dem.refuse_ballpark(&plan).unwrap_err();
        check_words(&error, &["custom.vrt", "Custom", "--allow-ballpark", "-a_srs", "datum"]);
    }
}

/// A datum on the ellipsoid of WGS84 or GRS80 was made for satellite positioning: it agrees with
/// WGS84 within metres.
#[test]
fn a_datum_without_a_name_on_the_ellipsoid_of_grs80_is_told_and_not_refused() {
    let folder = folder();
    let file = custom(folder.path(), "Unknown based on GRS80 ellipsoid", GRS80);
    let dem = open(std::slice::from_ref(&file));
    let plan = plan(&dem);
    dem.refuse_ballpark(&plan).unwrap();
    let [only] = plan.datum_operations.as_slice() else { panic!("{:?}", plan.datum_operations) };
    assert!(only.record.ballpark && only.record.accuracy_m.is_none());
    assert!(only.warning().unwrap().contains("unknown accuracy"));
}

const WEST_OF_IT: [f64; 2] = [2_451_194.441_5, 1_151_695.830_5];
const INSIDE: [f64; 2] = [2_566_327.701_7, 1_149_948.852_1];

/// West of 5.96° E the registry has no operation for CH1903+. A DEM that reaches there is
/// transformed by a single operation nevertheless: otherwise it would break at that meridian. The
/// value is that of GDAL for the same projection with an explicit shift
/// (`+towgs84=674.374,15.056,405.346`).
#[test]
fn a_dem_that_reaches_beyond_the_area_of_its_datum_stays_in_one_piece() {
    let data = Bounds { min_x: 2.45e6, min_y: 1.1e6, max_x: 2.6e6, max_y: 1.2e6 };
    let crs = RecordedCrs::new("EPSG:2056", [1.0; 2], data).unwrap();
    let area = Bounds { min_x: 5.4, min_y: 46.0, max_x: 7.5, max_y: 47.0 };
    for at in [[5.5, 46.5], [7.0, 46.5]] {
        let mut point = [at];
        crs.projection(area).unwrap().working_from_wgs84(&mut point).unwrap();
        let expected = if at[0] < 6.0 { WEST_OF_IT } else { INSIDE };
        let off_m = (point[0][0] - expected[0]).hypot(point[0][1] - expected[1]);
        assert!(off_m < 0.01, "{at:?} is at {point:?}, {off_m} m off");
    }
    let found = crs.datum_operations(data, area).unwrap();
    assert!(found.len() == 1 && !found[0].record.ballpark, "{found:?}");
}
