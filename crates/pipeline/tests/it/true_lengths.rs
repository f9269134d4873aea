//! Lengths of roads are true lengths in any CRS, and the lengths of parts add up exactly, in
//! micrometres.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use crate::support::{Built, Options, build_files, extract, write_samples};
use corniche_tileset::FilePackage;
use corniche_verify::{VerifySettings, verify};
use corniche_work::Silent;
use geo::{Distance, Geodesic, Point};

/// Longitudes and latitudes of the DEMs.
const WEST_DEG: f64 = 9.0;
const NORTH_DEG: f64 = 47.2;

/// Roads that wander over the DEM, its voids and its edge, the same in each run.
fn roads() -> Vec<Vec<[f64; 2]>> {
    let mut state = 12_345_u64;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1_u64 << 24) as f64
    };
    (0..60)
        .map(|_| {
            let mut at = [WEST_DEG + 0.25 * next() - 0.02, NORTH_DEG - 0.25 * next() + 0.02];
            (0..40)
                .map(|_| {
                    at = [at[0] + 0.012 * (next() - 0.5), at[1] + 0.008 * (next() - 0.5)];
                    at.map(|degrees| (degrees * 1e7).round() / 1e7)
                })
                .collect()
        })
        .collect()
}

/// Karney's geodesics on WGS84, as implemented by `geo`.
fn geodesic_m(roads: &[Vec<[f64; 2]>]) -> f64 {
    let pair_m = |pair: &[[f64; 2]]| {
        let [from, to] = [pair[0], pair[1]].map(|[lon, lat]| Point::new(lon, lat));
        Geodesic.distance(from, to)
    };
    roads.iter().flat_map(|road| road.windows(2).map(pair_m)).sum()
}

/// Roads over a DEM of 200 × 200 samples in a CRS, with holes; `first` and `spacing` in its units.
fn built(epsg: u32, first: [f64; 2], spacing: f64) -> Built {
    let folder = tempfile::tempdir().unwrap();
    let [dem, osm] = ["dem.tif", "roads.osm.pbf"].map(|name| folder.path().join(name));
    let height_m = |k: usize| {
        let (column, row) = (k % 200, k / 200);
        let is_void = (60..110).contains(&column) && (40..120).contains(&row);
        if is_void { -9999.0 } else { 500.0 + (column as f32 / 9.0).sin() * 80.0 + row as f32 }
    };
    write_samples(
        &dem,
        [200, 200],
        (epsg, first, [spacing; 2]),
        (0..200 * 200).map(height_m).collect(),
    );
    extract::write_lines(&osm, &roads());
    let built = build_files(&dem, Some(&osm), Options::plain(8.0)).unwrap();
    let package = folder.path().join("again.pmtiles");
    std::fs::write(&package, &built.bytes).unwrap();
    let settings =
        VerifySettings { dem: vec![dem], photo: Vec::new(), osm: None, threads: 2, polygon: None };
    let report = verify(&FilePackage::open(&package).unwrap(), &settings, &Silent).unwrap();
    let broken: Vec<_> = report.checks.iter().filter(|check| !check.holds()).collect();
    assert!(broken.is_empty(), "EPSG:{epsg}: {broken:?}");
    built
}

#[test]
fn lengths_are_those_of_geodesics_in_every_crs_and_parts_add_up_exactly() {
    let expected_m = geodesic_m(&roads());
    for (epsg, first, spacing) in [
        (4326, [WEST_DEG, NORTH_DEG], 0.001),
        (3857, [1_001_900.0, 5_976_400.0], 120.0),
        (3395, [1_001_900.0, 5_944_700.0], 120.0),
        (32632, [500_000.0, 5_227_500.0], 80.0),
        (3035, [4_246_000.0, 2_680_000.0], 80.0),
    ] {
        let counts = built(epsg, first, spacing).manifest.counts;
        let in_m = counts.roads_in_um as f64 / 1e6;
        // Points are snapped to the millimetre.
        assert!(
            (in_m / expected_m - 1.0).abs() < 2e-6,
            "EPSG:{epsg}: {in_m} m, not {expected_m} m"
        );
        let lost_um: Vec<u64> = counts.roads_lost.iter().map(|loss| loss.length_um).collect();
        assert_eq!(
            counts.roads_in_um,
            counts.roads_kept_um + lost_um.iter().sum::<u64>(),
            "EPSG:{epsg}"
        );
        // Losses outside count beyond the tiles of the data: there are none if one tile is larger
        // than all data.
        assert!(lost_um[1] > 10_000_000_000, "EPSG:{epsg}: {lost_um:?}");
        assert!(epsg != 4326 || lost_um[0] > 1_000_000_000, "EPSG:{epsg}: {lost_um:?}");
        let by_class: u64 = counts.classes.iter().map(|&(_, um)| um).sum();
        assert_eq!(by_class, counts.roads_in_um);
    }
}
