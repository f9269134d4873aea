//! Roads outside the elevation data are lost as such, also in the padding of the data's tiles;
//! roads over voids are not.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::path::Path;

use corniche_pipeline::build;
use corniche_tileset::{FilePackage, Manifest, RoadLoss};
use corniche_verify::{VerifyOsm, VerifySettings, verify};
use corniche_work::Silent;
use geo::{Distance as _, Geodesic, Point};

use crate::support::{
    Options, Raster,
    extract::{self, StraightRoad, utm_to_degrees},
    settings, table,
};

/// 60 × 50 samples, 10 m apart, with a void of 13 × 7 of them, on one tile of 257 × 257 nodes.
fn raster() -> Raster {
    let is_void = |column, row| (8..=20).contains(&column) && (28..=34).contains(&row);
    let height = move |column, row| 400.0 + (column + 2 * row) as f32;
    Raster::new(
        [60, 50],
        [0, 0],
        move |column, row| {
            if is_void(column, row) { f32::NAN } else { height(column, row) }
        },
    )
}

/// Roads, each with the place of its loss: wholly in the padding, from the data into the padding,
/// over the void, and outside all tiles.
const ROADS: [StraightRoad; 4] = [
    StraightRoad { from: [70.0, 20.0], to: [120.0, 20.0] },
    StraightRoad { from: [30.0, 10.0], to: [90.0, 10.0] },
    StraightRoad { from: [10.0, 31.0], to: [15.0, 31.0] },
    StraightRoad { from: [300.0, 20.0], to: [310.0, 20.0] },
];

/// The geodesic's length between two positions (column, row), micrometres.
fn true_um(raster: &Raster, from: [f64; 2], to: [f64; 2]) -> u64 {
    let places = utm_to_degrees(&[from, to].map(|at| raster.position_m(at)));
    let [from, to] = [places[0], places[1]].map(|[lon, lat]| Point::new(lon, lat));
    (Geodesic.distance(from, to) * 1e6).round() as u64
}

fn built(folder: &Path) -> Manifest {
    raster().write(&folder.join("dem.tif"));
    extract::write(&folder.join("roads.osm.pbf"), &raster(), &ROADS);
    let osm = Some(folder.join("roads.osm.pbf"));
    let settings =
        settings(folder.join("dem.tif"), osm, folder.join("a.pmtiles"), Options::plain(1.0));
    build(&settings, &Silent).unwrap().manifest
}

fn broken(folder: &Path) -> Vec<String> {
    let settings = VerifySettings {
        dem: vec![folder.join("dem.tif")],
        photo: Vec::new(),
        osm: Some(VerifyOsm {
            paths: vec![folder.join("roads.osm.pbf")],
            table: table(),
            memory_bytes: 64 << 20,
        }),
        threads: 2,
        polygon: None,
    };
    let package = FilePackage::open(&folder.join("a.pmtiles")).unwrap();
    let report = verify(&package, &settings, &Silent).unwrap();
    let broken = report.checks.iter().filter(|check| !check.holds());
    broken.map(|check| format!("{}: {:?}", check.id.id(), check.examples)).collect()
}

#[test]
fn roads_in_the_padding_of_tiles_are_outside_the_data() {
    let folder = tempfile::tempdir().unwrap();
    let counts = built(folder.path()).counts;
    let raster = raster();
    let length = |from, to| true_um(&raster, from, to);
    let wholly = length(ROADS[0].from, ROADS[0].to) + length(ROADS[3].from, ROADS[3].to);
    // Column 59 has the last samples.
    let beside = wholly + length([59.0, 10.0], ROADS[1].to);
    let void = length(ROADS[2].from, ROADS[2].to);
    let lost = |reason: &str| -> &RoadLoss {
        counts.roads_lost.iter().find(|loss| loss.reason.contains(reason)).unwrap()
    };
    let (outside, over_void) = (lost("outside the elevation data"), lost("no ground"));
    assert_eq!((counts.roads_kept, outside.roads, over_void.roads), (1, 2, 1), "{counts:?}");
    // Coordinates are rounded to 1e-7 degrees, a centimetre.
    for (found_um, right_um) in [(outside.length_um, beside), (over_void.length_um, void)] {
        assert!(found_um.abs_diff(right_um) < 30_000, "{found_um} µm, by geodesics {right_um} µm");
    }
    let lost_um: u64 = counts.roads_lost.iter().map(|loss| loss.length_um).sum();
    assert_eq!(counts.roads_kept_um + lost_um, counts.roads_in_um);
    let broken = broken(folder.path());
    assert!(broken.is_empty(), "{broken:#?}");
}
