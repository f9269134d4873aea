//! Roads of one long segment are as long as the straight line on the map, as a whole and at the
//! edge of data.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use corniche_testing::{
    pbf::{BlockBuilder, file},
    real_data,
};
use e2e::{corniche, manifest, text};
use serde_json::Value;

/// Builds and verifies a package; returns its manifest and the length of its exported road.
fn built([dem, osm]: [&Path; 2], folder: &Path) -> (Value, f64) {
    let package = folder.join("roads.pmtiles");
    let inputs = ["--dem", text(dem), "--osm", text(osm)];
    let ran = corniche([&["build", "-q", "-O", "-o", text(&package)], &inputs[..]].concat());
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    for more in [&[][..], &inputs[..]] {
        let ran = corniche([&["verify", text(&package)], more].concat());
        assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    }
    let csv = folder.join("roads.csv");
    let ran = corniche(["export", "roads", text(&package), "-O", "-o", text(&csv)]);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    let rows = fs::read_to_string(&csv).unwrap();
    let mut lines = rows.lines();
    // The geometry comes first, in quotes.
    let (_, names) = lines.next().unwrap().split_once(',').unwrap();
    let at = names.split(',').position(|name| name == "length_2d_m").unwrap();
    let length_m = |line: &str| {
        let (_, fields) = line.split_once(")\",").unwrap();
        fields.split(',').nth(at).unwrap().parse::<f64>().unwrap()
    };
    let length_m = lines.map(length_m).sum();
    (manifest(&package), length_m)
}

#[test]
fn long_segments_are_as_long_as_the_line_on_the_map() {
    let folder = tempfile::tempdir().unwrap();
    for (name, expected_m) in [("ross", 64_314.61), ("utm70n", 60_023.50)] {
        let Some(dem) = real_data(&format!("cases/long-segments/{name}.tif")) else { return };
        let osm = dem.with_extension("osm.pbf");
        let (manifest, length_m) = built([&dem, &osm], folder.path());
        let kept_m = manifest["counts"]["roads_kept_um"].as_f64().unwrap() / 1e6;
        assert!((kept_m - expected_m).abs() < 0.02, "{name}: {kept_m}");
        assert!((length_m - expected_m).abs() < 0.02, "{name}: {length_m}");
    }
}

/// A way with one node at 0°, 0°, a common error in extracts: the kept length equals the length in
/// the tiles.
#[test]
fn ways_to_no_place_at_all_are_cut_where_data_end() {
    let folder = tempfile::tempdir().unwrap();
    for (name, [lon, lat]) in [
        ("long-segments/ross", [-1786, -781]),
        ("long-segments/utm70n", [150, 701]),
        ("sea-beyond-data/lon10", [100, -170]),
    ] {
        let Some(dem) = real_data(&format!("cases/{name}.tif")) else { return };
        let mut block = BlockBuilder::new();
        block.dense(&[(1, lat * 1_000_000, lon * 1_000_000), (2, 0, 0)]);
        block.way(1, &[("highway", "primary")], &[1, 2]);
        let osm: PathBuf = folder.path().join("null.osm.pbf");
        fs::write(&osm, file(&block)).unwrap();
        let (manifest, length_m) = built([&dem, &osm], folder.path());
        let counts = &manifest["counts"];
        let kept_m = counts["roads_kept_um"].as_f64().unwrap() / 1e6;
        assert!(
            kept_m > 1000.0 && (kept_m - length_m).abs() < 1e-5 * kept_m,
            "{name}: {kept_m} {length_m}"
        );
    }
}
