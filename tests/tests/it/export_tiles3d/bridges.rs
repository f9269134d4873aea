//! `export 3dtiles` of a package with spans: bridges are closed slabs with the rows of their ways,
//! and nothing else changes.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
};

use e2e::{copy_pass, ground::FromEarth};
use tempfile::TempDir;

use super::{
    export, pass,
    tiles::{NamedTriangles, Tiles, files_of, has_ending},
};

const SLAB: &str = "bridge_slab";

type Place = [u64; 3];

/// Directed edges of triangles as positions, without those that also exist in the other direction;
/// a closed surface has none.
fn open<'a>(
    parts: impl Iterator<Item = (&'a NamedTriangles, [usize; 3])>,
) -> BTreeMap<[Place; 2], i32> {
    let mut sums: BTreeMap<[Place; 2], i32> = BTreeMap::new();
    for (part, corners) in parts {
        let places = corners.map(|corner| part.at_m[corner].map(|axis| (axis + 0.0).to_bits()));
        for k in 0..3 {
            let (from, to) = (places[k], places[(k + 1) % 3]);
            if from != to {
                *sums.entry([from.min(to), from.max(to)]).or_default() +=
                    if from < to { 1 } else { -1 };
            }
        }
    }
    sums.retain(|_, sum| *sum != 0);
    sums
}

#[test]
fn bridges_are_closed_slabs_of_their_ways() {
    let folder = TempDir::new().unwrap();
    let options = ["--dem-vertical-crs", "EPSG:5773", "--relief", "off"];
    let [spans, ground] = ["spans.pmtiles", "ground.pmtiles"].map(|name| folder.path().join(name));
    copy_pass(&spans, &[&options[..], &["--structures", "spans"]].concat());
    copy_pass(&ground, &[&options[..], &["--structures", "ground"]].concat());
    let tiles = Tiles::read(&export(&spans, "spans", &[]), &spans);
    tiles.check_tree().unwrap();
    let from_earth = FromEarth::to(&pass());
    let mut ways = BTreeSet::new();
    let mut highest_m: f64 = 0.0;
    for tile in &tiles.tiles {
        let is_slab = |part: &&NamedTriangles| part.name == SLAB;
        let sides = || {
            let parts = tile.parts.iter().filter(is_slab);
            parts.flat_map(|part| part.triangles.iter().map(move |corners| (part, *corners)))
        };
        let edges = open(sides());
        // Roads on top begin at the open edges of the sides.
        let on_edge: BTreeSet<Place> = edges.keys().flatten().copied().collect();
        let tops = tile.parts.iter().filter(|part| part.name.starts_with("roads"));
        let tops = tops
            .flat_map(|part| part.triangles.iter().map(move |corners| (part, *corners)))
            .filter(|(part, corners)| {
                corners.iter().all(|corner| {
                    on_edge.contains(&part.at_m[*corner].map(|axis| (axis + 0.0).to_bits()))
                })
            });
        assert_eq!(open(sides().chain(tops)).len(), 0, "{}", tile.name);
        for part in tile.parts.iter().filter(is_slab) {
            ways.extend(part.ways.iter().copied());
            assert_eq!(part.ways.len(), part.at_m.len());
            let on_earth: Vec<_> = part.at_m.iter().map(|at| tiles.on_earth(*at)).collect();
            for [x, y, z] in from_earth.carry(&on_earth) {
                if let Some(ground_m) = tile.ground.height([x, y]) {
                    highest_m = highest_m.max(z - ground_m);
                }
            }
        }
    }
    assert!(ways.contains(&137), "{ways:?}");
    assert!((5.0..200.0).contains(&highest_m), "{highest_m} m above the ground");
    // Roads as lines are the same with and without spans.
    let files = |package, name| {
        let folder = export(package, name, &["--roads", "line"]);
        let files = files_of(&folder).into_iter().filter(|(name, _)| has_ending(name, "glb"));
        files.map(|(name, path)| (name, fs::read(path).unwrap())).collect::<BTreeMap<_, _>>()
    };
    assert!(files(&spans, "spans-lines") == files(&ground, "ground-lines"));
    let without = Tiles::read(&export(&ground, "ground", &[]), &ground).part_names();
    assert!(!without.contains(SLAB) && tiles.part_names().contains(SLAB));
}
