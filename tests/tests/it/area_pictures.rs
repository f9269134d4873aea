//! Areas in rendered images, through the whole binary.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path};

use corniche_testing::pbf::{BlockBuilder, file};
use e2e::{Ran, corniche, draw, sample, text};

/// The sample `pass` with one road and one lake in its centre.
fn build(folder: &Path, layers: &str) -> std::path::PathBuf {
    let osm = folder.join("lake.osm.pbf");
    let mut block = BlockBuilder::new();
    let places = [(950, 4690), (955, 4690), (955, 4694), (950, 4694)];
    let nodes = (1..).zip(places).map(|(id, (lon, lat))| (id, lat * 100_000, lon * 100_000));
    block.dense(&nodes.collect::<Vec<_>>());
    block.way(1, &[("highway", "primary")], &[1, 3]);
    block.way(2, &[("natural", "water")], &[1, 2, 3, 4, 1]);
    fs::write(&osm, file(&block)).unwrap();
    let package = folder.join(format!("{layers}.pmtiles"));
    let dem = sample("pass/pass-dem.tif");
    let inputs = ["--dem", text(&dem), "--osm", text(&osm), "--max-error", "10"];
    let more = ["build", "-q", "-o", text(&package), "--layers", layers];
    let ran = corniche([&more[..], &inputs[..]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    package
}

/// Returns `None` if there is no adapter.
fn render(package: &Path, png: &Path, options: &[&str]) -> Option<(Ran, Vec<u8>)> {
    let ran = draw(
        "render",
        package,
        png,
        &[&["-O", "--size", "200x150", "--legend"], options].concat(),
    )?;
    assert_eq!(ran.code, 0, "{}", ran.err);
    let picture = fs::read(png).unwrap();
    Some((ran, picture))
}

#[test]
#[ignore = "slow: two builds of a country and six pictures"]
fn areas_are_drawn_unless_they_are_off_and_then_nothing_is_different_from_a_package_without() {
    let folder = tempfile::tempdir().unwrap();
    let [with, without] = ["areas", "none"].map(|layers| build(folder.path(), layers));
    let png = folder.path().join("a.png");
    let Some((drawn, on)) = render(&with, &png, &[]) else { return };
    assert!(drawn.err.contains(" polygons of areas with "), "{}", drawn.err);
    let (hidden, off) = render(&with, &png, &["--layers", "none"]).unwrap();
    assert!(!hidden.err.contains("areas"), "{}", hidden.err);
    let (_, bare) = render(&without, &png, &[]).unwrap();
    assert!(off == bare, "areas that are off change a picture");
    assert!(on != bare, "areas are not drawn");
    for style in ["dark", "relief", "photo"] {
        let (_, on) = render(&with, &png, &["--style", style]).unwrap();
        let (_, off) = render(&with, &png, &["--style", style, "--layers", "none"]).unwrap();
        assert!(on != off, "{style} draws no water");
    }
}
