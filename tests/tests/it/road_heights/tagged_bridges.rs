//! Bridges and tunnels as mapped in the ways of public bug reports: their heights, on the elevation
//! files and in packages.

#![allow(clippy::float_cmp, reason = "a flag is 0 or 1")]

use std::{collections::BTreeMap, fs, path::PathBuf};

use e2e::{build_from, corniche, json, manifest, real_data, text};

use super::{Line, Row, features, number, succeed};

/// The results of a case.
struct Made {
    /// The roads, by way.
    roads: BTreeMap<i64, (Row, Vec<Line>)>,
    edges: Vec<Row>,
    /// The messages of exports about bridges and tunnels.
    said: String,
    /// The list of defects of the build.
    defects: String,
    /// Reasons to inspect a bridge or a tunnel, from the manifest.
    reasons: Vec<String>,
    crossings: u64,
}

/// Builds a case and exports it; `verify` holds with its extract.
fn made(dem: &str, osm: &str) -> Option<Made> {
    let [dem, osm] = [dem, osm].map(|name| real_data(&format!("cases/{name}")));
    let (dem, osm) = (dem?, osm?);
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| -> PathBuf { folder.path().join(name) };
    let [package, defects] = ["case.pmtiles", "defects.csv"].map(at);
    build_from([&dem, &osm], &package, &["-q", "--classes", "0-8", "--defects", text(&defects)]);
    let verified = ["verify", "--json", text(&package), "--osm", text(&osm)];
    for check in json(&verified)["checks"].as_array().unwrap() {
        assert_ne!(check["holds"], false, "{check:#}");
    }
    let inputs = ["--dem", text(&dem), "--osm", text(&osm)];
    let run = |what: &str| {
        let target = at(&format!("{what}.gpkg"));
        let words = ["export", what, text(&package), "-o", text(&target)];
        (succeed(corniche([&words[..], &inputs].concat())), features(&target))
    };
    let (ran, roads) = run("roads");
    let (_, edges) = run("edges");
    let spans = &manifest(&package)["spans"];
    let reasons = spans["reasons"].as_array().unwrap().iter();
    Some(Made {
        roads: roads
            .into_iter()
            .map(|(row, lines)| (row["way_id"].parse().unwrap(), (row, lines)))
            .collect(),
        edges: edges.into_iter().map(|(row, _)| row).collect(),
        said: ran.out + &ran.err,
        defects: fs::read_to_string(defects).unwrap(),
        reasons: reasons.map(|own| own["reason"].as_str().unwrap().to_owned()).collect(),
        crossings: spans["crossings"].as_u64().unwrap(),
    })
}

impl Made {
    fn heights_m(&self, way_id: i64) -> impl Iterator<Item = f64> + '_ {
        self.roads[&way_id].1.iter().flatten().map(|at| at[2])
    }

    /// All heights of a way are close to one value.
    fn is_level(&self, way_id: i64, height_m: f64, within_m: f64) {
        for found in self.heights_m(way_id) {
            assert!((found - height_m).abs() <= within_m, "way {way_id}: {found}");
        }
    }

    fn number(&self, way_id: i64, field: &str) -> f64 {
        number(&self.roads[&way_id].0, field)
    }
}

/// A viaduct 60 m above a street keeps its height, whether the street shares a node with it or not;
/// the street keeps its own.
#[test]
fn a_street_below_does_not_pull_a_viaduct_down() {
    for name in ["apart", "joined"] {
        let Some(made) = made("through-way/valley.tif", &format!("through-way/{name}.osm.pbf"))
        else {
            return;
        };
        made.is_level(2, 599.88, 0.01);
        made.is_level(5, 540.04, 0.01);
        assert!(made.number(2, "ascent_m") < 0.01);
        let is_joined = name == "joined";
        assert_eq!(made.reasons, if is_joined { vec!["ground_way_on_deck"] } else { vec![] });
        assert_eq!(made.defects.contains("node 3"), is_joined, "{}", made.defects);
        assert_eq!(made.said.contains("ground_way_on_deck: node 3"), is_joined, "{}", made.said);
        let at_node: Vec<(String, f64)> = made
            .edges
            .iter()
            .flat_map(|row| {
                [("from_node", "from_height_m"), ("to_node", "to_height_m")]
                    .map(|(node, height)| (row, node, height))
            })
            .filter(|(row, node, _)| row[*node] == "3")
            .map(|(row, _, height)| (row["ways"].clone(), number(row, height)))
            .collect();
        assert_eq!(at_node.len(), if is_joined { 4 } else { 0 });
        for (ways, height_m) in at_node {
            let expected = if ways.starts_with('5') { 540.04 } else { 599.88 };
            assert!((height_m - expected).abs() < 0.01, "{ways}: {height_m}");
        }
    }
}

/// A shared node at one point, a shared stretch of 100 m, and neither: the same crossing.
#[test]
fn places_in_common_are_crossings() {
    for name in ["no-nodes", "same-place", "stretch"] {
        let osm = format!("nodes-on-one-place/{name}.osm.pbf");
        let Some(made) = made("nodes-on-one-place/flat.tif", &osm) else { return };
        assert_eq!(made.crossings, 1, "{name}");
        assert!(made.said.contains("1 with 1 crossings"), "{name}: {}", made.said);
        assert!((made.number(2, "free_height_m") - 1.0).abs() < 1e-6, "{name}");
        assert!((made.heights_m(2).fold(0.0, f64::max) - 101.0).abs() < 1e-6, "{name}");
        made.is_level(5, 100.0, 1e-6);
        assert_eq!(made.reasons, Vec::<String>::new(), "{name}");
    }
}

#[test]
fn a_bridge_without_a_layer_lies_under_one_with_layer_1() {
    let Some(made) = made("layer-0-under-1/flat.tif", "layer-0-under-1/layers.osm.pbf") else {
        return;
    };
    assert_eq!(made.reasons, Vec::<String>::new());
    made.is_level(6, 100.0, 1e-6);
    assert!((made.heights_m(2).fold(0.0, f64::max) - 101.0).abs() < 1e-6);
    assert!((made.number(2, "free_height_m") - 1.0).abs() < 1e-6);
}

#[test]
fn a_bridge_keeps_room_over_a_tunnel() {
    let Some(made) = made("bridge-over-tunnel/dem.tif", "bridge-over-tunnel/roads.osm.pbf") else {
        return;
    };
    assert_eq!(made.reasons, Vec::<String>::new());
    for way_id in [2, 5] {
        assert!(made.number(way_id, "free_height_m") >= 0.3);
    }
    assert!(made.heights_m(5).fold(f64::INFINITY, f64::min) <= 99.7);
    assert_eq!(made.number(5, "grade_over_limit"), 0.0);
}

/// The roundabout's approaches from both sides of the cutting carry it; the road that leaves it in
/// the cutting is reported.
#[test]
fn a_roundabout_on_a_bridge_is_carried_by_its_approaches() {
    let Some(made) = made("ring-on-bridge/dem.tif", "ring-on-bridge/roads.osm.pbf") else { return };
    assert_eq!(made.roads[&1].0["height_source"], "deck");
    assert!(made.heights_m(1).all(|height_m| height_m > 99.99), "{:?}", made.roads[&1]);
    assert!(made.number(1, "free_height_m") > 5.0);
    assert_eq!(made.reasons, ["ground_way_on_deck"]);
    assert!(made.defects.contains("node 1:"), "{}", made.defects);
}
