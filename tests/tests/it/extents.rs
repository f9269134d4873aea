//! The sea and areas end at the edges of the data, of the extract's bounding box and of the bounds;
//! bounds around the whole earth omit nothing along the longitude.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use corniche_testing::{
    pbf::{self, PbfWay},
    real_data,
};
use e2e::{corniche, layer, manifest, text, write_ascii_grid};
use serde_json::Value;

/// Builds and verifies a package with areas, and returns its manifest and the areas of its exported
/// polygons, km², by class.
fn built([dem, osm]: [&Path; 2], folder: &Path, more: &[&str]) -> (Value, Vec<(String, f64)>) {
    built_from((&[dem], osm), folder, more)
}

fn built_from(
    (dem, osm): (&[&Path], &Path),
    folder: &Path,
    more: &[&str],
) -> (Value, Vec<(String, f64)>) {
    let package = folder.join("areas.pmtiles");
    let dem: Vec<&str> = dem.iter().map(|file| text(file)).collect();
    let inputs = [&["--dem"], &dem[..], &["--osm", text(osm)]].concat();
    let options = ["-q", "-O", "--layers", "areas", "-o", text(&package)];
    let ran = corniche([&["build"], &inputs[..], &options, more].concat());
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    let ran = corniche([&["verify", text(&package)], &inputs[..]].concat());
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    let exported = folder.join("areas.geojson");
    let crs = ["--crs", "EPSG:4326", "-O", "-o", text(&exported)];
    let ran = corniche([&["export", "layer", "areas", text(&package)], &crs[..]].concat());
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    let features: Value = serde_json::from_slice(&fs::read(&exported).unwrap()).unwrap();
    let area = |feature: &Value| {
        let properties = &feature["properties"];
        let class = properties["class"].as_str().unwrap().to_owned();
        (class, properties["area_m2"].as_f64().unwrap() / 1e6)
    };
    let areas = features["features"].as_array().unwrap().iter().map(area).collect();
    (manifest(&package), areas)
}

/// An island in data of one degree: the sea fills the rest of the data and of the extract's
/// bounding box, in degrees and in UTM.
#[test]
fn the_sea_ends_where_data_and_box_end() {
    let Some(dem) = real_data("cases/sea-beyond-data/lon10.tif") else { return };
    let folder = tempfile::tempdir().unwrap();
    for (name, expected_km2) in [
        ("no-box", 11_437.25),
        ("box-inside", 7_310.25),
        ("box-larger", 11_437.25),
        ("box-180", 9_149.60),
        ("forest", 11_673.07),
    ] {
        let osm = dem.with_file_name(format!("{name}.osm.pbf"));
        for (crs, allowed) in [(&[][..], 1e-6), (&["--crs", "utm"], 1e-4)] {
            let (manifest, areas) = built([&dem, &osm], folder.path(), crs);
            let [(_, exported_km2)] = &areas[..] else { panic!("{name}: {areas:?}") };
            let is_right = |found: f64| (found / expected_km2 - 1.0).abs() < allowed;
            assert!(is_right(*exported_km2), "{name} {crs:?}: {exported_km2}");
            // The manifest has the whole area of OSM objects.
            let counted_km2 = layer(&manifest, "areas")["kept"][0]["area_km2"].as_f64().unwrap();
            assert!(name == "forest" || is_right(counted_km2), "{name} {crs:?}: {counted_km2}");
        }
    }
}

/// Three files that leave the fourth corner of their rectangle free: a forest over all of it ends
/// where each file does. They share a row or a column of samples, so it is as large as the sum of
/// the forests over each file.
#[test]
fn areas_end_where_files_leave_a_corner_free() {
    let folder = tempfile::tempdir().unwrap();
    let osm = folder.path().join("forest.osm.pbf");
    let nodes: [(i64, [f64; 2]); 4] =
        [(1, [8.9, 46.9]), (2, [9.5, 46.9]), (3, [9.5, 47.3]), (4, [8.9, 47.3])];
    let tags = vec![("natural", "wood")];
    let ways = [PbfWay { id: 1, tags, node_ids: vec![1, 2, 3, 4, 1] }];
    fs::write(&osm, pbf::network(&[], &nodes, &ways)).unwrap();
    let quarter = |name: &str, [lon, lat]: [f64; 2]| {
        let dem = folder.path().join(format!("{name}.asc"));
        let place = format!("xllcenter {lon}\nyllcenter {lat}\ncellsize 0.005\nNODATA_value -9999");
        write_ascii_grid(&dem, [41, 21], &place, |column, row| (300 + 2 * column + row) as f64);
        dem
    };
    let all = [
        quarter("south-west", [9.0, 47.0]),
        quarter("south-east", [9.2, 47.0]),
        quarter("north-west", [9.0, 47.1]),
    ];
    let dem_crs = ["--dem-crs", "EPSG:4326"];
    let forest_km2 = |dem: &[&Path], more: &[&str]| -> f64 {
        let (found, areas) = built_from((dem, &osm), folder.path(), &[&dem_crs, more].concat());
        assert_eq!(found["outline"].is_null(), dem.len() == 1 && more.is_empty());
        areas.iter().map(|(_, km2)| km2).sum()
    };
    let alone_km2: f64 = all.iter().map(|dem| forest_km2(&[dem], &[])).sum();
    let paths: Vec<&Path> = all.iter().map(PathBuf::as_path).collect();
    for (crs, allowed) in [(&[][..], 1e-5), (&["--crs", "utm"], 1e-4)] {
        let found_km2 = forest_km2(&paths, crs);
        assert!((found_km2 / alone_km2 - 1.0).abs() < allowed, "{crs:?} {found_km2} {alone_km2}");
    }
}

/// Bounds that are curved in UTM: the ground fills the rectangle around their image, but the sea
/// does not.
#[test]
fn the_sea_ends_where_bounds_end() {
    let Some(dem) = real_data("cases/sea-beyond-data/lon10.tif") else { return };
    let folder = tempfile::tempdir().unwrap();
    let osm = dem.with_file_name("no-box.osm.pbf");
    let bounds = ["--crs", "utm", "--bounds=9.6,-17.3,10.4,-16.5"];
    let (_, areas) = built([&dem, &osm], folder.path(), &bounds);
    let [(_, exported_km2)] = &areas[..] else { panic!("{areas:?}") };
    assert!((exported_km2 / 7_310.25 - 1.0).abs() < 1e-4, "{exported_km2}");
}

/// Data of one degree across 180°: bounds around the earth have no effect along the longitude.
#[test]
fn bounds_around_the_earth_over_180_degrees() {
    let Some(dem) = real_data("cases/bounds-at-180/at180.tif") else { return };
    let folder = tempfile::tempdir().unwrap();
    let osm = dem.with_file_name("fiji.osm.pbf");
    let (whole, _) = built([&dem, &osm], folder.path(), &[]);
    for bounds in ["-180,-17.3,180,-16.5", "-180,-90,180,90", "osm"] {
        let (part, _) = built([&dem, &osm], folder.path(), &[&format!("--bounds={bounds}")]);
        for side in ["min_x", "max_x"] {
            let [own, all] =
                [&part, &whole].map(|found| found["wgs84_bounds"][side].as_f64().unwrap());
            assert!((own - all).abs() < 1e-9, "{bounds}: {own} {all}");
        }
        assert_eq!(part["counts"]["roads_kept_um"], whole["counts"]["roads_kept_um"], "{bounds}");
    }
}
