//! `--roads vector`: a second tileset with the lines of the first one's tiles.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

use e2e::ground::{FromEarth, Ground};
use serde_json::Value;
use tempfile::TempDir;

use super::{built, export, glb::Glb, pass, tiles::Tiles};

/// The largest value of an index, which ends a strip.
const RESTART: [u32; 2] = [0xFFFF, 0xFFFF_FFFF];

/// Boxes, errors and contents of tiles, by their names.
fn tree(folder: &Path) -> (Value, BTreeMap<String, (Value, Option<Value>)>) {
    let document: Value =
        serde_json::from_slice(&fs::read(folder.join("tileset.json")).unwrap()).unwrap();
    let mut found = BTreeMap::new();
    let mut open = vec![&document["root"]];
    while let Some(tile) = open.pop() {
        let name = tile["metadata"]["properties"]["tile"].as_str().unwrap().to_owned();
        let known = Value::from(vec![
            tile["boundingVolume"].clone(),
            tile["geometricError"].clone(),
            tile["metadata"].clone(),
        ]);
        found.insert(name, (known, tile.get("content").cloned()));
        open.extend(tile["children"].as_array().into_iter().flatten());
    }
    (document, found)
}

/// A straight segment between two positions, by their bits, and its way.
type Segment = (i64, [[u64; 3]; 2]);

fn segment(way: i64, ends: [[f64; 3]; 2]) -> Segment {
    (way, ends.map(|at| at.map(f64::to_bits)))
}

/// The strips of a tile; each belongs to one way.
fn strips(glb: &Glb) -> Vec<(i64, Vec<[f64; 3]>)> {
    let ways = glb.ways();
    let mut found = Vec::new();
    for (number, primitive) in glb.primitives.iter().enumerate() {
        assert_eq!(glb.document["meshes"][0]["primitives"][number]["mode"], 3);
        for strip in primitive.indices.split(|index| RESTART.contains(index)) {
            assert!(strip.len() > 1, "a strip of {} points", strip.len());
            let rows: BTreeSet<u32> =
                strip.iter().map(|index| primitive.features[*index as usize]).collect();
            assert_eq!(rows.len(), 1, "a strip of several ways");
            let way = ways[*rows.first().unwrap() as usize];
            found.push((way, strip.iter().map(|index| primitive.at_m[*index as usize]).collect()));
        }
    }
    found
}

/// Boxes and errors of both tilesets are the same, so that a client shows the same level; the
/// ground is that of an export without roads; each line of `--roads line` exists, to the bit, at
/// the same height above the package's ground.
#[test]
fn vectors_are_the_lines_in_a_tileset_of_their_own() {
    let folder = TempDir::new().unwrap();
    let package = built(&folder);
    let vector = export(&package, "vector", &["--roads", "vector"]);
    let line = export(&package, "line", &["--roads", "line"]);
    let none = export(&package, "none", &["--roads", "none"]);
    let frame = Tiles::read(&none, &package);
    let roads = vector.join("roads");
    let ((_, ground), (document, tiles)) = (tree(&vector), tree(&roads));
    assert_eq!(document["extensionsUsed"], serde_json::json!(["3DTILES_content_gltf_vector"]));
    assert!(document.get("extensionsRequired").is_none());
    let known = |tree: &BTreeMap<String, (Value, Option<Value>)>| -> BTreeMap<String, Value> {
        tree.iter().map(|(name, (known, _))| (name.clone(), known.clone())).collect()
    };
    assert_eq!(known(&ground), known(&tiles));
    let from_earth = FromEarth::to(&pass());
    let (mut segments, mut heights) = (0, 0);
    for (name, (_, content)) in &tiles {
        let file = format!("{name}.glb");
        assert_eq!(fs::read(vector.join(&file)).unwrap(), fs::read(none.join(&file)).unwrap());
        let lines = Glb::read(&line.join(&file));
        let ways = lines.ways();
        let expected: BTreeSet<Segment> = lines
            .primitives
            .iter()
            .filter(|primitive| !primitive.features.is_empty())
            .flat_map(|primitive| {
                primitive.indices.as_chunks::<2>().0.iter().map(|ends| {
                    let [one, other] = ends.map(|end| end as usize);
                    let way = ways[primitive.features[one] as usize];
                    segment(way, [primitive.at_m[one], primitive.at_m[other]])
                })
            })
            .collect();
        let Some(content) = content else {
            assert!(expected.is_empty(), "{name} has lines, but no content");
            continue;
        };
        assert_eq!(content["extensions"]["3DTILES_content_gltf_vector"]["vector"], true);
        let glb = Glb::read(&roads.join(content["uri"].as_str().unwrap()));
        let used = glb.document["extensionsUsed"].as_array().unwrap();
        assert!(used.iter().any(|name| name == "KHR_mesh_primitive_restart"), "{used:?}");
        assert!(glb.document.get("extensionsRequired").is_none());
        let strips = strips(&glb);
        let found: BTreeSet<Segment> = strips
            .iter()
            .flat_map(|(way, at)| at.windows(2).map(|ends| segment(*way, [ends[0], ends[1]])))
            .collect();
        assert_eq!(found, expected, "{name}");
        segments += found.len();
        heights += check_lift(&strips, &frame, &from_earth, &Ground::read(&package, name));
    }
    assert!(segments > 1000 && heights > 1000, "{segments} {heights}");
    let style = fs::read(roads.join("style.json")).unwrap();
    let style: Value = serde_json::from_slice(&style).unwrap();
    assert_eq!(style["color"]["conditions"].as_array().unwrap().len(), 9);
}

/// Checks that all points of a tile are at the same height above its ground, within the promised
/// centimetre; returns the number of points.
fn check_lift(
    strips: &[(i64, Vec<[f64; 3]>)],
    frame: &Tiles,
    from_earth: &FromEarth,
    ground: &Ground,
) -> usize {
    let on_earth: Vec<[f64; 3]> =
        strips.iter().flat_map(|(_, at)| at).map(|at| frame.on_earth(*at)).collect();
    let lifts: Vec<f64> = from_earth
        .carry(&on_earth)
        .into_iter()
        .filter_map(|[x, y, z]| Some(z - ground.height([x, y])?))
        .collect();
    let [low, high] = lifts.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], lift| {
        [low.min(*lift), high.max(*lift)]
    });
    assert!(low > 0.01 && high - low < 0.02, "from {low} to {high} m above the ground");
    lifts.len()
}
