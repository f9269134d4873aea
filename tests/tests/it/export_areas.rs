//! Areas that leave a package, read back by OGR.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::path::Path;

use e2e::{corniche, extract_with_areas, sample, text};
use gdal::{
    Dataset, Metadata as _,
    vector::{Feature, Geometry, LayerAccess as _},
};

/// Sides of a cell of the extract's lattice, metres.
const CELL_M: [f64; 2] = [382.0, 444.7];

fn build(folder: &Path, areas: &str) -> std::path::PathBuf {
    let package = folder.join(format!("{areas}.pmtiles"));
    let (dem, osm) = (sample("pass/pass-dem.tif"), extract_with_areas(folder));
    let inputs = ["build", "-q", "--dem", text(&dem), "--osm", text(&osm), "--max-error", "10"];
    let ran = corniche([&inputs[..], &["--areas", areas, "-o", text(&package)]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    package
}

/// What a feature holds: object and id, class, polygons, holes, share of the area that the lattice says.
fn told(feature: &Feature<'_>, cells: f64) -> (String, String, usize, usize) {
    let field = |name: &str| {
        feature.field_as_string(feature.field_index(name).unwrap()).unwrap().unwrap_or_default()
    };
    let geometry = feature.geometry().unwrap();
    assert!(geometry.is_valid());
    let polygons = geometry.geometry_count();
    let holes = |polygon: usize| geometry.get_geometry(polygon).geometry_count() - 1;
    let area_m2: f64 = field("area_m2").parse().unwrap();
    let ratio = area_m2 / (cells * CELL_M[0] * CELL_M[1]);
    assert!((ratio - 1.0).abs() < 0.005, "{ratio}");
    assert_eq!(field("polygons"), polygons.to_string());
    let name = format!("{} {} {}", field("object"), field("id"), field("name"));
    (name.trim().to_owned(), field("class"), polygons, (0..polygons).map(holes).sum())
}

/// The rings' points, without the closing ones.
fn points(geometry: &Geometry) -> usize {
    match geometry.geometry_count() {
        0 => geometry.point_count() - 1,
        count => (0..count).map(|part| points(&geometry.get_geometry(part))).sum(),
    }
}

#[test]
fn areas_come_back_whole_in_each_format() {
    let folder = tempfile::tempdir().unwrap();
    let package = build(folder.path(), "default");
    for (ending, more) in [
        ("gpkg", &[][..]),
        ("fgb", &[]),
        ("csv", &[]),
        ("geojson", &["--crs", "EPSG:4326"]),
        ("gpkg", &["--crs", "EPSG:4326", "-O"]),
    ] {
        let file = folder.path().join(format!("areas.{ending}"));
        let ran =
            corniche([&["export", "areas", text(&package), "-o", text(&file)], more].concat());
        assert_eq!(ran.code, 0, "{}", ran.err);
        assert!(ran.err.contains("2 areas of level"), "{}", ran.err);
        assert!(ran.err.contains("© OpenStreetMap contributors"), "{}", ran.err);
        let dataset = Dataset::open(&file).unwrap();
        if ending == "gpkg" {
            let credits = dataset.metadata_item("ATTRIBUTION", "").unwrap();
            assert!(credits.contains("OpenStreetMap"), "{credits}");
        }
        let mut layer = dataset.layer(0).unwrap();
        let mut all: Vec<_> = layer
            .features()
            .map(|feature| {
                // Of four corners each, on the package's finest lattice, and points on borders of tiles.
                assert!((4..40).contains(&points(feature.geometry().unwrap())));
                let is_lake = feature.field_as_string(feature.field_index("id").unwrap());
                let is_lake = is_lake.unwrap().as_deref() == Some("2");
                told(&feature, if is_lake { 9.0 } else { 32.0 })
            })
            .collect();
        all.sort();
        let lake = ("way 2 Lake".to_owned(), "water".to_owned(), 1, 0);
        let wood = ("relation 7".to_owned(), "forest".to_owned(), 1, 1);
        assert_eq!(all, [wood, lake], "{ending}");
    }
}

#[test]
fn levels_and_classes_can_be_chosen_and_areas_that_are_not_there_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let package = build(folder.path(), "default");
    let file = folder.path().join("areas.geojson");
    let export = |package: &Path, more: &[&str]| {
        let words =
            ["export", "areas", text(package), "-O", "--crs", "EPSG:4326", "-o", text(&file)];
        corniche([&words[..], more].concat())
    };
    let ran = export(&package, &["--classes", "water", "--level", "0"]);
    assert!(ran.code == 0 && ran.err.contains("1 areas of level 0"), "{}", ran.err);
    let ran = export(&package, &["--classes", "water,glacier"]);
    assert!(ran.code == 0 && ran.err.contains("1 areas of level"), "{}", ran.err);

    let refused = |ran: e2e::Ran, why: &str| {
        assert_eq!(ran.code, 2, "{}", ran.err);
        assert!(ran.err.contains(why), "{}", ran.err);
    };
    refused(export(&package, &["--classes", "pond"]), "classes of areas are sea, water, glacier");
    refused(export(&package, &["--level", "9"]), "has no level 9");
    refused(export(&build(folder.path(), "off"), &[]), "it was built without --areas");
    let words = ["export", "areas", text(&package), "-O", "-o", text(&file)];
    refused(corniche(words), "give --crs EPSG:4326");
    // What was there stays.
    assert_eq!(json_features(&file), 1);
}

fn json_features(file: &Path) -> usize {
    let text = std::fs::read_to_string(file).unwrap();
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    value["features"].as_array().unwrap().len()
}
