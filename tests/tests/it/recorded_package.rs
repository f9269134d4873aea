//! A package from an earlier version of the program, with every kind of section of that time, is
//! opened, verified, drawn and exported with the same results as then.
//!
//! `tests/golden/README.md` describes how it was created. If one of these tests fails, existing
//! packages of users are read differently.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::BTreeMap,
    fs,
    io::Read as _,
    path::{Path, PathBuf},
};

use corniche_testing::pictures::Golden;
use e2e::{corniche, draw, json, layer, manifest, objects, root, skip, text};
use gdal::{Dataset, vector::LayerAccess as _};
use serde_json::Value;
use tempfile::TempDir;

/// Kinds of sections, and the number of the five tiles that have them.
const KINDS: [(u16, &str, usize); 12] = [
    (1, "terrain", 5),
    (4, "road attributes", 5),
    (5, "road tags", 5),
    (6, "relief", 5),
    (7, "photo", 5),
    (10, "coded GEO roads", 5),
    (11, "coded SV roads", 5),
    (13, "spans", 3),
    (64, "areas", 4),
    (65, "railways", 2),
    (66, "boundaries", 5),
    (67, "stops", 3),
];
/// Kinds of road sections in packages in metres, which another recorded package has.
const KINDS_IN_METRES: [(u16, &str); 2] = [(2, "GEO roads"), (3, "SV roads")];

/// A tile, its contents (vertices, triangles, GEO lines, SV lines, ways, areas) and the checksum of
/// all its numbers.
const TILES: [(&str, [usize; 6], u32); 5] = [
    ("0/0/0", [1985, 3848, 75, 88, 88, 18], 2_213_765_394),
    ("1/0/0", [2754, 5360, 454, 690, 652, 40], 4_216_306_650),
    ("1/0/1", [2531, 4918, 521, 731, 714, 29], 283_654_998),
    ("1/1/0", [1063, 2017, 1, 6, 4, 0], 1_751_112_402),
    ("1/1/1", [1011, 1912, 24, 53, 42, 2], 2_486_351_119),
];

/// A tile, the numbers of its boundaries and railways, and the checksum of their ids and points.
const LINES: [(&str, [usize; 2], u32); 5] = [
    ("0/0/0", [49, 25], 3_726_138_138),
    ("1/0/0", [71, 34], 1_321_870_796),
    ("1/0/1", [48, 0], 1_745_052_563),
    ("1/1/0", [8, 0], 1_855_749_471),
    ("1/1/1", [22, 0], 2_350_016_144),
];

const CREDITS: [&str; 2] =
    ["Colours by height, made of SRTM", "© OpenStreetMap contributors, ODbL 1.0"];

fn recorded() -> PathBuf {
    root().join("tests/golden/all-sections.pmtiles")
}

fn recorded_in_metres() -> PathBuf {
    root().join("crates/tileset/tests/data/version-2.pmtiles")
}

/// A number of seven bits per byte, the lowest first, from the front of `bytes`.
fn varint(bytes: &mut &[u8]) -> usize {
    let mut value = 0;
    for shift in (0..).step_by(7) {
        let byte = usize::from(bytes.split_off_first().copied().unwrap());
        value |= (byte & 0x7f) << shift;
        if byte < 0x80 {
            break;
        }
    }
    value
}

/// The number of tiles with each kind of section, read by `FORMAT.md` alone. The package is so
/// small that its directory has no leaves.
fn kinds(package: &Path) -> BTreeMap<u16, usize> {
    let bytes = fs::read(package).unwrap();
    let number = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    let [entries, leaves, tiles] = [8, 40, 56].map(|at| number(at)..number(at) + number(at + 8));
    assert!(leaves.is_empty());
    let mut directory = Vec::new();
    flate2::read::GzDecoder::new(&bytes[entries]).read_to_end(&mut directory).unwrap();
    let rest = &mut &directory[..];
    let count = varint(rest);
    // Differences of ids, lengths of runs, lengths in bytes, offsets. Tiles follow each other
    // without gaps.
    let columns = [(); 4].map(|()| (0..count).map(|_| varint(rest)).collect::<Vec<_>>());
    let (mut kinds, mut left) = (BTreeMap::new(), &bytes[tiles]);
    for &length in &columns[2] {
        let payload = left.split_off(..length).unwrap();
        assert!(payload.starts_with(b"CRNT"));
        for section in payload[16..].chunks(20).take(payload[6].into()) {
            *kinds.entry(u16::from_le_bytes([section[0], section[1]])).or_default() += 1;
        }
    }
    assert!(left.is_empty());
    kinds
}

/// Adds all numbers of nested arrays, in their order, as little-endian f64.
fn add(sum: &mut crc32fast::Hasher, value: &Value) {
    match value {
        Value::Array(values) => values.iter().for_each(|value| add(sum, value)),
        number => sum.update(&number.as_f64().unwrap().to_le_bytes()),
    }
}

/// Adds named members of each object of a list.
fn add_each(sum: &mut crc32fast::Hasher, list: &[Value], members: &[&str]) {
    for object in list {
        for &member in members {
            add(sum, &object[member]);
        }
    }
}

/// Runs `corniche export` with the package; returns the path of its output in a folder.
fn export(folder: &TempDir, what: &str, name: &str) -> PathBuf {
    let path = folder.path().join(name);
    let words = ["export"].into_iter().chain(what.split(' '));
    let ran = corniche(words.chain([text(&recorded()), "-q", "-o", text(&path)]));
    assert_eq!(ran.code, 0, "{what}: {}{}", ran.out, ran.err);
    path
}

/// The files with an extension in a folder and its subfolders.
fn files_below(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files_below(&path, ending));
        } else if path.extension().is_some_and(|extension| extension == ending) {
            found.push(path);
        }
    }
    found
}

#[test]
fn every_kind_of_section_is_recorded() {
    let expected = KINDS.map(|(kind, _, tiles)| (kind, tiles));
    assert_eq!(kinds(&recorded()), BTreeMap::from(expected), "{KINDS:?}");
    let in_metres = kinds(&recorded_in_metres());
    for (kind, name) in KINDS_IN_METRES {
        assert!(in_metres.contains_key(&kind), "{name}: {in_metres:?}");
    }
}

#[test]
fn it_opens_and_tells_what_it_is() {
    let package = recorded();
    let manifest = manifest(&package);
    assert_eq!(manifest["format_version"], 2);
    assert_eq!(manifest["generator"], "corniche 0.1.0, GDAL 3.6.2, PROJ 9.1.1");
    assert_eq!(manifest["attribution"], serde_json::json!(CREDITS));
    let counts = &manifest["counts"];
    assert_eq!([&counts["roads_in"], &counts["roads_kept"]], [2749, 963]);
    assert_eq!(layer(&manifest, "areas")["objects"], 229);
    assert_eq!(layer(&manifest, "boundaries")["objects"], 1602);
    assert_eq!(e2e::kept(layer(&manifest, "railways")), [("service", 2), ("main", 32)]);
    let ran = corniche(["info", text(&package)]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let growth = json(&["growth", text(&package), "--json"]);
    let vertices = growth["rows"].as_array().unwrap().iter();
    assert_eq!(vertices.map(|row| row["geo_vertices"].as_u64().unwrap()).sum::<u64>(), 17_041);
}

#[test]
fn it_keeps_its_promises() {
    for package in [recorded(), recorded_in_metres()] {
        let report = json(&["verify", text(&package), "--json", "-q"]);
        assert_eq!(report["holds"], true, "{report}");
    }
    // A check without objects proves nothing.
    let report = json(&["verify", text(&recorded()), "--json", "-q"]);
    let checks = report["checks"].as_array().unwrap();
    for id in [
        "tiles.whole",
        "P1",
        "P3",
        "sv.range",
        "roads.attributes",
        "relief.seams",
        "photo.levels",
        "areas.seams",
        "lines.places",
        "spans.ends",
    ] {
        let check = checks.iter().find(|check| check["id"] == id).expect(id);
        assert!(check["checked"].as_u64().unwrap() > 0, "{check}");
    }
}

#[test]
fn its_tiles_are_decoded_to_the_same_numbers() {
    let package = recorded();
    for (id, expected, expected_sum) in TILES {
        let tile = json(&["tile", text(&package), id, "--json"]);
        let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
        let tin = &tile["tin"];
        let [geo, sv, ways] = ["roads_geo", "roads_sv", "attributes"].map(|name| list(&tile[name]));
        let areas = objects(&tile, "areas").to_vec();
        let [vertices, triangles] = ["vertices", "triangles"].map(|name| list(&tin[name]));
        let found = [&vertices, &triangles, &geo, &sv, &ways, &areas].map(Vec::len);
        assert_eq!(found, expected, "{id}");
        let mut sum = crc32fast::Hasher::new();
        for name in ["vertices", "normals", "triangles"] {
            add(&mut sum, &tin[name]);
        }
        add_each(&mut sum, &geo, &["way_id", "part", "frc", "line"]);
        add_each(&mut sum, &sv, &["way_id", "part", "frc", "line", "ground_range_m"]);
        add_each(&mut sum, &areas, &["id", "polygons"]);
        assert_eq!(sum.finalize(), expected_sum, "{id}");
    }
    for (id, expected, expected_sum) in LINES {
        let tile = json(&["tile", text(&package), id, "--json"]);
        let layers = ["boundaries", "railways"].map(|name| objects(&tile, name));
        let mut sum = crc32fast::Hasher::new();
        for lines in layers {
            add_each(&mut sum, lines, &["id", "line"]);
        }
        assert_eq!((layers.map(<[Value]>::len), sum.finalize()), (expected, expected_sum), "{id}");
    }
    // Texts of a road, a track, an area and a boundary.
    let tile = json(&["tile", text(&package), "1/0/0", "--json"]);
    let has = |list: &[Value], name: &str, value: &str| list.iter().any(|of| of[name] == value);
    let ways = tile["attributes"].as_array().unwrap();
    assert!(has(ways, "name", "Dorfstrasse") && has(ways, "highway", "tertiary"));
    assert!(has(ways, "tracktype", "grade2") && has(objects(&tile, "areas"), "class", "forest"));
    assert!(has(objects(&tile, "boundaries"), "class", "admin-8"));
}

#[test]
fn it_is_drawn_as_it_was() {
    let folder = TempDir::new().unwrap();
    let golden = Golden::of_crate(text(&root()), option_env!("CARGO_TARGET_TMPDIR"));
    for roads in ["sv", "geo"] {
        let png = folder.path().join(format!("{roads}.png"));
        let options = ["--size", "320x240", "--roads", roads];
        let Some(ran) = draw("render", &recorded(), &png, &options) else { return };
        assert_eq!(ran.code, 0, "{}", ran.err);
        if !["llvmpipe", "vulkan"].iter().all(|part| ran.err.contains(part)) {
            skip(&format!("these pictures are llvmpipe's, and this is {}", ran.err));
            return;
        }
        let picture = image::open(&png).unwrap().to_rgba8();
        golden.check(&format!("all-sections-{roads}"), &picture);
    }
}

#[test]
fn its_roads_and_layers_are_exported() {
    let folder = TempDir::new().unwrap();
    let features = |what: &str| {
        let dataset = Dataset::open(export(&folder, what, &format!("{what}.gpkg"))).unwrap();
        dataset.layer(0).unwrap().feature_count()
    };
    assert_eq!(["roads", "layer areas"].map(features), [963, 66]);
    // Of 109 boundaries and 34 railways, the others are beside the ground.
    assert_eq!(["layer boundaries", "layer railways"].map(features), [38, 7]);
}

#[test]
fn its_ground_is_exported_as_a_raster_and_as_a_model() {
    let folder = TempDir::new().unwrap();
    let raster = Dataset::open(export(&folder, "geotiff", "heights.tif")).unwrap();
    assert_eq!(raster.raster_size(), (157, 85));
    let heights = raster.rasterband(1).unwrap().read_band_as::<f64>().unwrap();
    let range = heights.data().iter().fold([f64::MAX, f64::MIN], |[low, high], &height_m| {
        [low.min(height_m), high.max(height_m)]
    });
    assert_eq!(range.map(|height_m| height_m as i32), [441, 2242], "whole metres here");

    let model = fs::read_to_string(export(&folder, "mesh", "model.obj")).unwrap();
    let lines = ["v ", "f ", "l "]
        .map(|begin| model.lines().filter(|line| line.starts_with(begin)).count());
    assert_eq!(lines, [23_645, 14_207, 1000], "vertices, triangles, lines of roads");
}

#[test]
fn it_is_exported_as_3d_tiles() {
    let folder = TempDir::new().unwrap();
    let tiles = export(&folder, "3dtiles", "tiles");
    let tileset: Value =
        serde_json::from_slice(&fs::read(tiles.join("tileset.json")).unwrap()).unwrap();
    assert_eq!(tileset["asset"]["copyright"], CREDITS.join("; "));
    let files = files_below(&tiles, "glb");
    assert_eq!(files.len(), 5);
    let mut triangles = 0;
    for file in files {
        // A header, the length of the document, its kind, the document.
        let bytes = fs::read(file).unwrap();
        let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
        let document: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
        assert_eq!(document["images"].as_array().map(Vec::len), Some(2), "photo and relief");
        for mesh in document["meshes"].as_array().unwrap() {
            for primitive in mesh["primitives"].as_array().unwrap() {
                let indices = primitive["indices"].as_u64().unwrap() as usize;
                triangles += document["accessors"][indices]["count"].as_u64().unwrap() / 3;
            }
        }
    }
    assert_eq!(triangles, 106_011, "ground, walls and roads");
}

#[test]
fn it_is_exported_as_quantized_mesh() {
    let folder = TempDir::new().unwrap();
    let terrain = export(&folder, "quantized-mesh", "terrain");
    let layer: Value =
        serde_json::from_slice(&fs::read(terrain.join("layer.json")).unwrap()).unwrap();
    assert_eq!(layer["attribution"], CREDITS.join("; "));
    let levels = layer["available"].as_array().unwrap();
    let tiles = levels.iter().flat_map(|level| level.as_array().unwrap()).map(|tiles| {
        let count = |low: &str, high: &str| {
            tiles[high].as_u64().unwrap() - tiles[low].as_u64().unwrap() + 1
        };
        count("startX", "endX") * count("startY", "endY")
    });
    assert_eq!((levels.len(), tiles.sum::<u64>()), (14, 50));
    assert_eq!(files_below(&terrain, "terrain").len(), 50);
}
