//! Ways that return over their own nodes are measured along their course: reversed in the extract,
//! they have the same values in reverse.

use std::{collections::BTreeMap, path::Path};

use e2e::text;

use super::{Line, PlainWay, Row, export, features, number, package_with, profile, succeed};

/// Positions of the nodes of each shape, in degrees from its first one.
const PLACES: [[f64; 2]; 5] =
    [[0.0, 0.0], [0.006, 0.001], [0.013, -0.001], [0.016, 0.0015], [0.022, 0.0]];
/// Ways that return: nodes by their number among the positions, from 1.
const SHAPES: [&[i64]; 8] = [
    &[1, 2, 1],
    &[1, 2, 3, 2, 1],
    // A spur, and an end that is passed twice.
    &[1, 2, 3, 2, 4],
    &[1, 2, 3, 4, 3],
    &[1, 2, 1, 2],
    // Around a loop and on, back, and back and on.
    &[1, 2, 3, 4, 2],
    &[1, 2, 3, 4, 2, 1],
    &[1, 2, 3, 4, 2, 1, 5],
];

/// A package of all shapes on the ground, and of all as bridges east of them, each on its own
/// nodes; if they are reversed, all run the other way.
fn package_of_shapes(folder: &Path, name: &str, is_turned: bool) -> [String; 3] {
    let mut nodes = Vec::new();
    let mut ways: Vec<(Vec<i64>, &str)> = Vec::new();
    for (west, structure) in [(8.975, ""), (9.005, "bridge")] {
        for (shape, row) in SHAPES.iter().zip(0..) {
            let first = 100 * (1 + ways.len() as i64);
            let south = 46.9175 + 0.0055 * f64::from(row);
            for (id, [east, north]) in (first + 1..).zip(PLACES) {
                nodes.push((id, [west + east, south + north]));
            }
            let mut way: Vec<i64> = shape.iter().map(|place| first + place).collect();
            if is_turned {
                way.reverse();
            }
            ways.push((way, structure));
        }
    }
    let ways: Vec<PlainWay<'_>> = ways.iter().map(|(way, of)| (&way[..], *of)).collect();
    package_with(folder, name, (&nodes, &ways)).map(|path| text(&path).to_owned())
}

/// Names of fields, of which two are swapped when a road is reversed.
fn turned(name: &str) -> &str {
    match name {
        "ascent_m" => "descent_m",
        "descent_m" => "ascent_m",
        "ground_ascent_m" => "ground_descent_m",
        "ground_descent_m" => "ground_ascent_m",
        other => other,
    }
}

fn are_alike(found: &Row, expected: &Row, of: impl Fn(&str) -> &str) {
    for name in found.keys() {
        // Vertices of decks on a straight line are omitted: the last bits decide which these are.
        if name == "vertices_out" && found["height_source"] == "deck" {
            continue;
        }
        let (found_text, expected_text) = (&found[name], &expected[of(name)]);
        match (found_text.parse::<f64>(), expected_text.parse::<f64>()) {
            (Ok(one), Ok(other)) => {
                assert!((one - other).abs() < 0.002, "{name}: {found:?} {expected:?}");
            }
            _ => assert_eq!(found_text, expected_text, "{name}: {found:?}"),
        }
    }
}

#[test]
fn turned_ways_have_the_same_fields_the_other_way_around() {
    let folder = tempfile::tempdir().unwrap();
    let [there, back] = [false, true].map(|is_turned| {
        let [dem, osm, package] =
            package_of_shapes(folder.path(), &is_turned.to_string(), is_turned);
        let inputs = ["--dem", &dem, "--osm", &osm];
        // Without elevation files, way by way, and by chains on both sides of a meridian.
        let west = ["--bounds", "8.9,46,8.9785,47"];
        let east = ["--bounds", "8.9785,46,9.1,47"];
        let options =
            [&[][..], &inputs[..2], &[&inputs[..], &west].concat(), &[&inputs[..], &east].concat()]
                .map(|options| [options, &["-O"]].concat());
        options.map(|options| {
            let target = folder.path().join("roads.gpkg");
            succeed(export(Path::new(&package), "roads", &target, &options));
            features(&target)
        })
    });
    for (there, back) in there.iter().zip(&back) {
        assert!(there.len() >= SHAPES.len());
        assert_eq!(there.len(), back.len());
        for ((found, lines), (expected, expected_lines)) in there.iter().zip(back) {
            are_alike(found, expected, turned);
            // Heights are in reverse order.
            let heights = |line: &Line| -> Vec<f64> { line.iter().map(|at| at[2]).collect() };
            if let ([line], [other]) = (&lines[..], &expected_lines[..])
                && found["height_source"] != "deck"
            {
                let (own, other) = (heights(line), heights(other));
                assert_eq!(own.len(), other.len(), "{found:?}");
                let mut pairs = own.iter().zip(other.iter().rev());
                assert!(pairs.all(|(one, other)| (one - other).abs() < 0.002), "{found:?}");
            }
        }
    }
}

/// Loops run the same way around, and other edges start at the same node.
#[test]
fn edges_of_turned_ways_are_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let [there, back] = [false, true].map(|is_turned| -> Vec<Row> {
        let name = is_turned.to_string();
        let [dem, osm, package] = package_of_shapes(folder.path(), &name, is_turned);
        let target = folder.path().join(format!("{name}.csv"));
        let inputs = ["--dem", &dem, "--osm", &osm];
        succeed(export(Path::new(&package), "edges", &target, &inputs));
        features(&target).into_iter().map(|(row, _)| row).collect()
    });
    assert_eq!(there.len(), back.len());
    for (found, expected) in there.iter().zip(&back) {
        // Vertices of decks may differ, as above.
        let on_ground = |row: &Row| -> Row {
            let is_same =
                |name: &String| name != "ways" && (name != "WKT" || row["bridge_share"] == "0");
            row.clone().into_iter().filter(|(name, _)| is_same(name)).collect()
        };
        are_alike(&on_ground(found), &on_ground(expected), |name| name);
    }
}

/// A profile along a way there and back, or twice around, has the smoothed line and the deck of its
/// chains each time.
#[test]
fn profiles_there_and_back_are_mirrored() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, osm, package] = package_of_shapes(folder.path(), "shapes", false);
    let ids: Vec<String> = (1..=2 * SHAPES.len()).map(|id| id.to_string()).collect();
    let by_way = |ways: String| -> BTreeMap<String, Vec<Row>> {
        let (rows, _) = profile(Path::new(&package), &ways, &["--dem", &dem, "--osm", &osm]);
        let mut of_ways: BTreeMap<String, Vec<Row>> = BTreeMap::new();
        for row in rows {
            of_ways.entry(row["way_id"].clone()).or_default().push(row);
        }
        of_ways
    };
    let once = by_way(ids.join(","));
    let twice = by_way(ids.iter().map(|id| format!("{id},{id}")).collect::<Vec<_>>().join(","));
    let heights = |rows: &[Row], name: &str| -> Vec<f64> {
        rows.iter().map(|row| number(row, name)).collect()
    };
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for (id, shape) in ids.iter().zip(SHAPES.iter().chain(&SHAPES)) {
        let (there, both) = (&once[id], &twice[id]);
        let source = &there[0]["height_source"];
        *counts.entry(source).or_default() += 1;
        assert!(both.iter().all(|row| row["height_source"] == *source), "{id}: {shape:?}");
        if source == "ground_under_bridge" {
            continue;
        }
        for name in ["height_m", "smooth_m"] {
            let mut second = heights(there, name);
            // A way that ends where it begins is followed twice in its direction.
            if shape.first() != shape.last() {
                second.reverse();
            }
            let expected = [heights(there, name), second.split_off(1)].concat();
            let found = heights(both, name);
            assert_eq!(found.len(), expected.len(), "{name} {shape:?}");
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 0.002, "{name} {shape:?}");
            }
        }
    }
    // Bridges to and fro without an end of their own have no support, and stay on the ground.
    assert_eq!(counts, BTreeMap::from([("dem", 8), ("deck", 4), ("ground_under_bridge", 4)]));
}
