//! Cells that are not square: all checks pass on scenes with cells of 1 : 1.5, wide and tall.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use crate::support::{
    Options, Raster,
    agreement::faults,
    build_files, extract,
    extract::StraightRoad,
    terrain::{TERRAINS, scattered_void},
};
use corniche_geom::Cell;
use corniche_pipeline::build;
use corniche_tileset::{FilePackage, Manifest};
use corniche_verify::{VerifyReport, VerifySettings, verify};
use corniche_work::Silent;
use proptest::prelude::*;

/// Sides of cells, east and north: tall, wide, and a square for comparison.
const CELLS: [[f64; 2]; 3] = [[10.0, 15.0], [15.0, 10.0], [12.0, 12.0]];

/// Roads between places of a raster of `size` samples, given as fractions of it: across tiles,
/// along rows, columns and diagonals.
fn roads(size: [usize; 2], shares: &[[f64; 4]]) -> Vec<StraightRoad> {
    let [columns, rows] = size.map(|samples| (samples - 1) as f64);
    let given = shares.iter().map(|[x0, y0, x1, y1]| StraightRoad {
        from: [x0 * columns, y0 * rows],
        to: [x1 * columns, y1 * rows],
    });
    let fixed = [
        StraightRoad { from: [1.0, 20.0], to: [columns - 1.0, 20.0] },
        StraightRoad { from: [20.0, 1.0], to: [20.0, rows - 1.0] },
        StraightRoad { from: [2.0, 2.0], to: [100.0, 100.0] },
    ];
    given.chain(fixed).collect()
}

/// The report of verify on a package, with the DEM from which it was built.
fn report(package: &std::path::Path, dem: &std::path::Path) -> VerifyReport {
    let settings = VerifySettings {
        dem: vec![dem.to_path_buf()],
        photo: Vec::new(),
        osm: None,
        threads: 2,
        polygon: None,
    };
    verify(&FilePackage::open(package).unwrap(), &settings, &Silent).unwrap()
}

fn manifest(package: &std::path::Path) -> Manifest {
    FilePackage::open(package).unwrap().manifest().clone()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: corniche_testing::cases(1, 3, 24), max_shrink_iters: 8, ..ProptestConfig::default() })]

    /// Seams, draping and errors: all properties of packages hold for any sides of a cell.
    #[test]
    fn every_promise_holds_on_rectangles(
        shape in 0_usize..3,
        terrain in 0_usize..6,
        has_voids in any::<bool>(),
        (columns, rows) in (280_usize..560, 280_usize..560),
        shift in [0_i64..256, 0_i64..256],
        shares in prop::collection::vec([0.0..1.0_f64, 0.0..1.0_f64, 0.0..1.0_f64, 0.0..1.0_f64], 3..8),
        max_error_m in 2.0..30.0_f64,
    ) {
        let (_, relief) = TERRAINS[terrain];
        let raster = Raster::new([columns, rows], shift, |column, row| {
            if has_voids && scattered_void(column, row) { f32::NAN } else { relief(column, row) }
        });
        let raster = raster.with_cells(CELLS[shape]);
        let folder = tempfile::tempdir().unwrap();
        let [dem, osm, package] = ["dem.tif", "roads.osm.pbf", "a.pmtiles"].map(|name| folder.path().join(name));
        raster.write(&dem);
        extract::write(&osm, &raster, &roads([columns, rows], &shares));
        let options = Options { fill_voids: 4, ..Options::plain(max_error_m) };
        build(&crate::support::settings(dem.clone(), Some(osm.clone()), package.clone(), options), &Silent).unwrap();
        let built = build_files(&dem, Some(&osm), options).unwrap();
        let faults = faults(&built);
        prop_assert!(faults.is_empty(), "{:#?}", &faults[..faults.len().min(10)]);
        let manifest = manifest(&package);
        prop_assert_eq!(manifest.frame.cell(), Cell::from(CELLS[shape]).fitted());
        prop_assert!(manifest.nodes_are_samples);
        let report = report(&package, &dem);
        let broken: Vec<_> = report.checks.iter().filter(|check| !check.holds()).collect();
        prop_assert!(broken.is_empty(), "{:#?}", broken);
        // The requested bound, at the DEM's own samples.
        let finest = manifest.levels.last().unwrap();
        prop_assert!(finest.sample_error.max_m <= max_error_m + manifest.vertical.quantum_m);
        prop_assert!(manifest.counts.roads_kept > 0);
    }
}

/// On a plane, every normal is the plane's normal in metres, not in cells.
#[test]
fn normals_are_those_of_metres_not_of_cells() {
    // Slopes in metres per metre; the normal is (−0.3, 0.2, 1).
    let slope = [0.3, -0.2];
    let sum = 0.3 + 0.2 + 1.0;
    let code = [-0.3, 0.2].map(|part: f64| (127.0 * part / sum).round() as i8);
    for cell_m in CELLS {
        let raster = Raster::new([300, 300], [0, 0], |column, row| {
            let [x_m, y_m] = [column as f64 * cell_m[0], -row as f64 * cell_m[1]];
            (1500.0 + slope[0] * x_m + slope[1] * y_m) as f32
        });
        let built =
            crate::support::build_raster(&raster.with_cells(cell_m), Options::plain(0.5)).unwrap();
        let mut count = 0;
        for (id, ground) in built.grounds() {
            for normal in &ground.normals {
                let off = [0, 1].map(|axis| (normal[axis] - code[axis]).abs());
                assert!(
                    off.iter().all(|&off| off <= 1),
                    "{id}, {cell_m:?}: {normal:?}, not {code:?}"
                );
                count += 1;
            }
        }
        assert!(count > 8, "{count}");
    }
}

/// If a cell is represented by a single length, it is the shorter side: the default error is a
/// sixteenth of it.
#[test]
fn the_shorter_side_stands_for_the_cell() {
    for cell_m in CELLS {
        let raster = Raster::new([300, 300], [0, 0], |column, _| column as f32).with_cells(cell_m);
        let folder = tempfile::tempdir().unwrap();
        let [dem, package] = ["dem.tif", "a.pmtiles"].map(|name| folder.path().join(name));
        raster.write(&dem);
        let mut settings =
            crate::support::settings(dem, None, package.clone(), Options::plain(1.0));
        settings.plan.terrain.max_error_m = None;
        build(&settings, &Silent).unwrap();
        let manifest = manifest(&package);
        let shorter_m = Cell::from(cell_m).fitted().shorter_m();
        assert!((manifest.settings.max_error_m - shorter_m / 16.0).abs() < 1e-9);
        // The margin is eight cells, but at least 40 m.
        let margins = manifest.levels.iter().map(|level| level.width_margin_m);
        let sides = manifest.levels.iter().map(|level| level.cell_m.shorter_m());
        assert!(
            margins.zip(sides).all(|(margin_m, side_m)| (margin_m - 8.0 * side_m).abs() < 1e-6)
        );
    }
}

/// Roads with cells in degrees: the DEM's own CRS, cells of 56 × 93 m, one package from a square
/// with SRTM's spacing.
#[test]
fn every_promise_holds_on_degrees() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, osm, package] =
        ["dem.tif", "roads.osm.pbf", "a.pmtiles"].map(|name| folder.path().join(name));
    let north_west = [9.0, 53.0];
    crate::support::write_degrees(&dem, 500, north_west, 1.0 / 1200.0, |[lon, lat]| {
        300.0 + 150.0 * (lon * 90.0).sin() + 150.0 * (lat * 120.0).cos()
    });
    // A raster of the same place in UTM, used only for the roads' ends.
    let origin = [500_000.0, 5_872_000.0];
    let place = Raster {
        columns: 2,
        rows: 2,
        west: 0,
        north: 0,
        heights_m: vec![0.0; 4],
        cell_m: [1.0, 1.0],
    };
    let at = |east_m: f64, south_m: f64| [origin[0] + east_m, south_m - origin[1]];
    let ends = [
        (at(1000.0, 1000.0), at(26_000.0, 40_000.0)),
        (at(26_000.0, 3000.0), at(2000.0, 44_000.0)),
        (at(500.0, 20_000.0), at(27_000.0, 20_010.0)),
        (at(13_000.0, 500.0), at(13_010.0, 45_000.0)),
    ];
    extract::write(&osm, &place, &ends.map(|(from, to)| StraightRoad { from, to }));
    build(
        &crate::support::settings(dem.clone(), Some(osm), package.clone(), Options::plain(5.0)),
        &Silent,
    )
    .unwrap();
    let manifest = manifest(&package);
    assert_eq!((manifest.crs.as_str(), manifest.nodes_are_samples), ("EPSG:4326", true));
    let cell = manifest.frame.cell();
    assert!(cell.east_m / cell.north_m < 0.62, "{cell}");
    let report = report(&package, &dem);
    let broken: Vec<_> = report.checks.iter().filter(|check| !check.holds()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
    assert_eq!((manifest.counts.roads_in, manifest.counts.roads_kept), (4, 4));
    // Straight lines in UTM, in which lengths near the meridian are true to 4 · 10⁻⁴.
    let length_m = |from: [f64; 2], to: [f64; 2]| (to[0] - from[0]).hypot(to[1] - from[1]);
    let expected_m: f64 = ends.iter().map(|&(from, to)| length_m(from, to) / 0.9996).sum();
    let found_m = manifest.counts.roads_in_um as f64 / 1e6;
    assert!((found_m / expected_m - 1.0).abs() < 2e-3, "{found_m} m, not {expected_m} m");
}
