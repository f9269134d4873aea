//! An extract without roads is rejected with the classes that are off, but accepted for its layers
//! if they are requested.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use corniche_testing::pbf::{BlockBuilder, file};
use e2e::{Ran, corniche, kept, layer, manifest, sample, text};

/// Tags, and positions on a lattice.
type Way<'a> = (&'a [(&'a str, &'a str)], &'a [[i64; 2]]);

/// Ways over the sample `pass`, each through points of a lattice 0.005 and 0.004 degrees apart.
fn extract(folder: &Path, name: &str, ways: &[Way<'_>]) -> PathBuf {
    let mut block = BlockBuilder::new();
    let place =
        |x: i64, y: i64| (100 + 20 * y + x, 468_700_000 + 40_000 * y, 95_000_000 + 50_000 * x);
    block.dense(&(0..400).map(|n| place(n % 20, n / 20)).collect::<Vec<_>>());
    for (id, (tags, places)) in (1..).zip(ways) {
        let nodes: Vec<i64> = places.iter().map(|&[x, y]| place(x, y).0).collect();
        block.way(id, tags, &nodes);
    }
    let path = folder.join(name);
    fs::write(&path, file(&block)).unwrap();
    path
}

const PATH: &[(&str, &str)] = &[("highway", "path")];
const FOOTWAY: &[(&str, &str)] = &[("highway", "footway")];
const LAKE: &[(&str, &str)] = &[("natural", "water")];
const BORDER: &[(&str, &str)] = &[("boundary", "administrative"), ("admin_level", "4")];
const LINE: &[[i64; 2]] = &[[3, 6], [6, 8], [9, 9]];
const RING: &[[i64; 2]] = &[[4, 5], [7, 5], [7, 9], [4, 9], [4, 5]];

fn build(folder: &Path, osm: &Path, options: &[&str]) -> Ran {
    let dem = sample("pass/pass-dem.tif");
    let target = folder.join("a.pmtiles");
    let line = ["build", "--dem", text(&dem), "--osm", text(osm), "-O", "-o", text(&target)];
    let coarse = ["--max-error", "20", "--relief", "off"];
    corniche(line.iter().chain(&coarse).chain(options))
}

/// A build of these inputs is rejected with these words.
#[track_caller]
fn refused(folder: &Path, osm: &Path, options: &[&str], words: &[&str]) {
    let ran = build(folder, osm, options);
    assert_eq!(ran.code, 2, "{}", ran.err);
    for word in words {
        assert!(ran.err.contains(word), "{word:?} is not in {}", ran.err);
    }
    assert!(!folder.join("a.pmtiles").exists());
}

/// A build of these inputs succeeds and is complete; returns its messages and its manifest.
#[track_caller]
fn built(folder: &Path, osm: &Path, options: &[&str]) -> (Ran, serde_json::Value) {
    let ran = build(folder, osm, options);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let package = folder.join("a.pmtiles");
    let verified = corniche(["verify", text(&package), "--osm", text(osm)]);
    assert_eq!(verified.code, 0, "{}{}", verified.out, verified.err);
    let manifest = manifest(&package);
    fs::remove_file(package).unwrap();
    (ran, manifest)
}

#[test]
fn an_extract_of_paths_alone_is_refused_with_the_classes_that_are_off() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let osm = extract(at, "paths.osm.pbf", &[(PATH, LINE), (PATH, &RING[..3]), (FOOTWAY, LINE)]);
    let words =
        ["paths.osm.pbf", "classes that are switched off: 8 (path 2, footway 1)", "--classes 0-8"];
    refused(at, &osm, &[], &words);
    let (_, manifest) = built(at, &osm, &["--classes", "0-8"]);
    assert_eq!(manifest["counts"]["roads_in"], 3);
    // Deselected classes are listed like those that the table turns off.
    let roads = extract(at, "roads.osm.pbf", &[(&[("highway", "primary")], LINE)]);
    refused(at, &roads, &["--classes", "3-8"], &["off: 2 (primary 1)", "--classes 0-8"]);
    let moat = extract(at, "moat.osm.pbf", &[(&[("highway", "moat")], LINE)]);
    refused(at, &moat, &[], &["does not list its highway values: moat 1", "--frc-table"]);
    let planned = extract(at, "planned.osm.pbf", &[(&[("highway", "proposed")], LINE)]);
    refused(at, &planned, &[], &["listed as no road (proposed 1)"]);
}

#[test]
fn an_extract_of_a_layer_alone_is_built_if_the_layer_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let lake = extract(at, "lake.osm.pbf", &[(LAKE, RING)]);
    refused(at, &lake, &[], &["none of its ways has a highway tag", "--layers"]);
    let (ran, manifest) = built(at, &lake, &["--layers", "areas"]);
    assert!(ran.err.contains("has no road: none of its ways has a highway tag"), "{}", ran.err);
    assert_eq!(manifest["counts"]["roads_in"], 0);
    assert_eq!(kept(layer(&manifest, "areas")), [("water", 1)]);
    let border = extract(at, "border.osm.pbf", &[(BORDER, LINE)]);
    refused(at, &border, &["--layers", "areas"], &["has no road"]);
    let (_, manifest) = built(at, &border, &["--layers", "boundaries"]);
    assert_eq!(layer(&manifest, "boundaries")["objects"], 1, "{}", manifest["layers"]);
    // Paths that are off, next to a lake.
    let both = extract(at, "both.osm.pbf", &[(PATH, LINE), (LAKE, RING)]);
    let (ran, manifest) = built(at, &both, &["--layers", "areas"]);
    assert!(ran.err.contains("off: 8 (path 1)"), "{}", ran.err);
    assert_eq!(manifest["counts"]["highways_in"], 1);
    // A lake next to the requested region.
    let part = ["--layers", "areas", "--bounds", "9.45,46.865,9.48,46.88"];
    refused(at, &lake, &part, &["lake.osm.pbf", "is on ground"]);
}
