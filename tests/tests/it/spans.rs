//! `corniche build --structures`: bridges and tunnels off the ground, in whole builds, in parts, on
//! recorded terrain and within bounds.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path};

use e2e::{
    COARSE, build_pass, built_in_parts, copy_pass, corniche, draw, json, manifest, real_data,
    sample, text,
};

const SPANS: [&str; 4] = ["--structures", "spans", "--classes", "0-8"];
const GROUND: [&str; 4] = ["--structures", "ground", "--classes", "0-8"];

/// `verify` with the extract holds, and checks spans.
fn holds(package: &Path, osm: &Path, more: &[&str]) {
    let report = json(&[&["verify", "--json", text(package), "--osm", text(osm)], more].concat());
    for check in report["checks"].as_array().unwrap() {
        let id = check["id"].as_str().unwrap();
        assert_ne!(check["holds"], false, "{check:#}");
        if ["spans.ends", "spans.side", "spans.sums", "osm.spans", "osm.spans.counts"].contains(&id)
        {
            assert!(check["checked"].as_u64().unwrap() > 0, "{check:#}");
        }
    }
}

/// The sample has seven bridges and two tunnels; without spans its tiles are otherwise the same.
#[test]
fn the_sample_has_its_bridges_and_tunnels() {
    let folder = tempfile::tempdir().unwrap();
    let [spans, ground] = ["spans", "ground"].map(|name| folder.path().join(name));
    copy_pass(&spans, &SPANS);
    copy_pass(&ground, &GROUND);
    let osm = sample("pass/pass.osm.pbf");
    holds(&spans, &osm, &[]);
    let [with, without] = [&spans, &ground].map(|package| manifest(package));
    let found = &with["spans"];
    assert_eq!(
        [&found["bridges"], &found["tunnels"]].map(serde_json::Value::as_u64),
        [Some(7), Some(2)]
    );
    assert_eq!(found["crossings"], 6);
    assert_eq!(without.get("spans"), None);
    for what in ["levels", "growth", "counts"] {
        assert_eq!(with[what], without[what], "{what}");
    }
}

/// Builds in parts, and on the terrain of a package, have the same bytes as one build.
#[test]
fn spans_do_not_depend_on_how_a_package_is_built() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    copy_pass(&at("whole.pmtiles"), &SPANS);
    let whole = fs::read(at("whole.pmtiles")).unwrap();
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let options = [&SPANS[..], &COARSE].concat();
    let inputs = [&["--dem", text(&dem), "--osm", text(&osm)][..], &options].concat();
    assert!(built_in_parts(folder.path(), &inputs) == whole, "in parts");
    let (ground, again) = (at("ground.pmtiles"), at("again.pmtiles"));
    build_pass(&ground, &["--classes", "0-3"]);
    let words =
        ["build", "-q", "--terrain", text(&ground), "--osm", text(&osm), "-o", text(&again)];
    let ran = corniche(words.iter().chain(&SPANS));
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(fs::read(&again).unwrap() == whole, "on the terrain of a package");
}

/// The gorge of the sample: a bridge over it with both methods, and none in a package with bridges
/// on the ground.
#[test]
fn pictures_show_bridges_in_the_air() {
    let folder = tempfile::tempdir().unwrap();
    let [spans, ground] = ["spans", "ground"].map(|name| folder.path().join(name));
    copy_pass(&spans, &["--classes", "0-8"]);
    copy_pass(&ground, &GROUND);
    let png = folder.path().join("a.png");
    let picture = |package: &Path, more: &[&str]| {
        let view = ["-O", "--size", "400x300", "--look-at", "9.5568,46.9202", "--distance", "500"];
        let place = ["--height", "1190", "--pitch", "60", "--heading", "30"];
        let ran = draw("render", package, &png, &[&view[..], &place, more].concat())?;
        assert_eq!(ran.code, 0, "{}", ran.err);
        Some(fs::read(&png).unwrap())
    };
    let Some(sv) = picture(&spans, &["--roads", "sv"]) else { return };
    assert!(picture(&spans, &["--roads", "geo"]).unwrap() == sv, "by the other method");
    assert!(picture(&ground, &["--roads", "sv"]).unwrap() != sv, "on the ground");
    let bare = [&spans, &ground].map(|package| picture(package, &["--roads", "none"]).unwrap());
    assert!(bare[0] == bare[1], "without roads");
}

/// Bounds through bridges and tunnels: their heights are those of the whole, and in parts and on
/// the terrain of a package the bytes are the same.
#[test]
fn spans_go_on_beyond_the_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (whole, package) = (at("all.pmtiles"), at("part.pmtiles"));
    copy_pass(&whole, &SPANS);
    let whole = manifest(&whole);
    let bounds = &whole["wgs84_bounds"];
    let [west, south, north] =
        ["min_x", "min_y", "max_y"].map(|side| bounds[side].as_f64().unwrap());
    // Through the bridge of way 137.
    let half = format!("--bounds={west},{south},9.5567,{north}");
    let options = [&SPANS[..], &[&half]].concat();
    build_pass(&package, &options);
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    holds(&package, &osm, &[]);
    let part = manifest(&package);
    assert_eq!(part["spans"]["reasons"], whole["spans"]["reasons"]);
    let bytes = fs::read(&package).unwrap();
    let inputs = [&["--dem", text(&dem), "--osm", text(&osm)][..], &options, &COARSE].concat();
    assert!(built_in_parts(folder.path(), &inputs) == bytes, "in parts");
    let again = at("again.pmtiles");
    let words =
        ["build", "-q", "--terrain", text(&package), "--osm", text(&osm), "-o", text(&again)];
    let ran = corniche(words.iter().chain(&SPANS));
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(fs::read(&again).unwrap() == bytes, "on the terrain of a package");
}

/// A polygon through the sample: roads begin where it clips them, and bridges and tunnels have the
/// same heights as along the whole road.
#[test]
fn spans_end_at_a_polygon() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("part.pmtiles");
    let polygon = sample("pass/part.geojson");
    let cut = ["--polygon", text(&polygon)];
    build_pass(&package, &[&SPANS[..], &cut].concat());
    holds(&package, &sample("pass/pass.osm.pbf"), &cut);
}

#[test]
fn spans_of_liechtenstein_hold() {
    let files = ["N47E009.hgt", "N47E010.hgt", "liechtenstein-2021-10-28.osm.pbf"]
        .map(|name| real_data(&format!("liechtenstein/{name}")));
    let [Some(west), Some(east), Some(osm)] = files else { return };
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("li.pmtiles");
    let words = ["build", "-q", "--dem", text(&west), text(&east), "--osm", text(&osm)];
    let ran = corniche(words.iter().chain(&["-o", text(&package)]).chain(&SPANS));
    assert_eq!(ran.code, 0, "{}", ran.err);
    holds(&package, &osm, &[]);
    let found = &manifest(&package)["spans"];
    assert_eq!(
        [&found["bridges"], &found["tunnels"]].map(serde_json::Value::as_u64),
        [Some(268), Some(22)]
    );
}
