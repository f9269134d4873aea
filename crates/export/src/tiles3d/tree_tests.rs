//! Every tile is found once in the documents of a tileset, and errors never grow downwards.

use std::{collections::BTreeSet, fs, path::Path};

use corniche_geom::TileId;
use corniche_testing::package::manifest;
use serde_json::Value;
use tempfile::TempDir;

use super::{Tree, content_name};
use crate::{
    globe::RootFrame,
    tiles3d::{content::TileContentFacts, placed::TileBox},
};

/// All tiles of this many levels, without a quarter of the first.
fn tiles(levels: u8) -> Vec<(TileId, TileContentFacts)> {
    let mut ids = vec![TileId::ROOT];
    let mut all = Vec::new();
    for _ in 0..levels {
        let children = ids.iter().flat_map(|id| id.children());
        let next: Vec<TileId> = children
            .filter(|id| id.z() == 0 || id.ancestor(1) != TileId::new(1, 1, 1).unwrap())
            .collect();
        all.append(&mut ids);
        ids = next;
    }
    let made = |id: TileId| {
        let mut tile_box = TileBox::along([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let side = 1024.0 / f64::from(1_u32 << id.z());
        tile_box.include([f64::from(id.x()) * side, f64::from(id.y()) * side, 0.0]);
        tile_box.include([f64::from(id.x() + 1) * side, f64::from(id.y() + 1) * side, 1.0]);
        // Some errors are no smaller on finer levels.
        let error_m = f64::from(id.x() % 7) + 1.0;
        let (package_triangles, triangles, road_triangles, cut_s) = Default::default();
        let bound_m = error_m;
        let facts = TileContentFacts {
            tile_box,
            bound_m,
            error_m,
            package_triangles,
            triangles,
            road_triangles,
            cut_s,
        };
        (id, facts)
    };
    all.into_iter().map(made).collect()
}

/// Reads a tile and all tiles below, following documents; adds the names of contents.
fn walk(folder: &Path, from: &Path, tile: &Value, least: f64, found: &mut Vec<String>) {
    let uri = tile["content"]["uri"].as_str().unwrap();
    let path = from.join(uri);
    let error_m = tile["geometricError"].as_f64().unwrap();
    assert!(error_m <= least);
    assert_eq!(tile["boundingVolume"]["box"].as_array().unwrap().len(), 12);
    if Path::new(uri).extension().is_some_and(|ending| ending == "json") {
        assert!(
            tile.get("children").is_none(),
            "a tile in another document has its children there"
        );
        let document: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
        assert_eq!(document["asset"]["version"], "1.1");
        assert!(document["root"].get("transform").is_none(), "the first document has it");
        return walk(folder, path.parent().unwrap(), &document["root"], error_m, found);
    }
    let mut place = Vec::new();
    for part in path.strip_prefix(folder).unwrap().components() {
        match part {
            std::path::Component::ParentDir => drop(place.pop()),
            other => place.push(other.as_os_str().to_str().unwrap()),
        }
    }
    found.push(place.join("/"));
    for child in tile["children"].as_array().unwrap_or(&Vec::new()) {
        walk(folder, from, child, error_m, found);
    }
}

/// In one document or in several, each tile occurs once, and errors never grow downwards.
#[test]
fn every_tile_is_found_once() {
    let manifest = manifest();
    let (mut seen, mut documents) = (Vec::new(), Vec::new());
    for levels in [1, 3, 6] {
        let tiles = tiles(levels);
        let expected: BTreeSet<String> = tiles.iter().map(|(id, ..)| content_name(*id)).collect();
        let folder = TempDir::new().unwrap();
        for (id, ..) in &tiles {
            let place = folder.path().join(id.z().to_string()).join(id.x().to_string());
            fs::create_dir_all(place).unwrap();
        }
        let tree = Tree::new(&manifest, tiles);
        documents.push(tree.write(folder.path(), &RootFrame::at([9.5, 47.0])).unwrap());
        let first = fs::read(folder.path().join("tileset.json")).unwrap();
        let first: Value = serde_json::from_slice(&first).unwrap();
        assert_eq!(first["root"]["transform"].as_array().unwrap().len(), 16);
        let mut found = Vec::new();
        walk(folder.path(), folder.path(), &first["root"], f64::INFINITY, &mut found);
        let names: BTreeSet<String> = found.iter().cloned().collect();
        assert_eq!(names, expected);
        assert_eq!(found.len(), names.len());
        seen.push(found.len());
    }
    assert_eq!(seen, [1, 16, 1024]);
    assert_eq!(documents, [1, 1, 1 + 192]);
}

/// A tileset of vectors is declared as such in each document; tiles without roads have no content,
/// but all children.
#[test]
fn vectors_are_named_where_there_are_some() {
    let manifest = manifest();
    for (levels, documents) in [(3, 1), (6, 1 + 192)] {
        let tiles = tiles(levels);
        let all = tiles.len();
        let with_roads: BTreeSet<TileId> =
            tiles.iter().map(|(id, ..)| *id).filter(|id| id.x() % 2 == 1).collect();
        let folder = TempDir::new().unwrap();
        for (id, ..) in &tiles {
            let place = folder.path().join(id.z().to_string()).join(id.x().to_string());
            fs::create_dir_all(place).unwrap();
        }
        let mut tree = Tree::new(&manifest, tiles);
        let root = RootFrame::at([9.5, 47.0]);
        tree.with_vectors = Some(with_roads.clone());
        assert_eq!(tree.write(folder.path(), &root).unwrap(), documents);
        let (mut named, mut seen) = (BTreeSet::new(), 0);
        let mut open = vec![folder.path().join("tileset.json")];
        while let Some(path) = open.pop() {
            let document: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
            assert_eq!(document["extensionsUsed"][0], "3DTILES_content_gltf_vector");
            assert!(document.get("extensionsRequired").is_none());
            let mut tiles = vec![&document["root"]];
            while let Some(tile) = tiles.pop() {
                tiles.extend(tile["children"].as_array().into_iter().flatten());
                let Some(content) = tile.get("content") else {
                    seen += 1;
                    continue;
                };
                let uri = content["uri"].as_str().unwrap();
                if Path::new(uri).extension().is_some_and(|ending| ending == "json") {
                    open.push(path.parent().unwrap().join(uri));
                    continue;
                }
                seen += 1;
                assert_eq!(content["extensions"]["3DTILES_content_gltf_vector"]["vector"], true);
                named.insert(uri.trim_start_matches("../").to_owned());
            }
        }
        assert_eq!(seen, all);
        assert_eq!(named, with_roads.into_iter().map(content_name).collect());
    }
}
