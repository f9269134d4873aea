//! Ways that come back over their own nodes are measured as they run: turned in the extract, they are the same the other way around.

use std::path::Path;

use e2e::text;

use super::{Line, PlainWay, Row, export, features, number, package_with, profile, succeed};

/// What carries the ways, with a name for files: the ground, or bridges.
const STRUCTURES: [(&str, &str); 2] = [("ground", ""), ("deck", "bridge")];

/// Places of the nodes of each shape, in degrees from its first one.
const PLACES: [[f64; 2]; 5] =
    [[0.0, 0.0], [0.006, 0.001], [0.013, -0.001], [0.016, 0.0015], [0.022, 0.0]];
/// Ways that come back: nodes by their number among the places, from 1.
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

/// A package of all shapes, each on its own nodes; where they are turned all run the other way.
fn package_of_shapes(folder: &Path, name: &str, structure: &str, is_turned: bool) -> [String; 3] {
    let mut nodes = Vec::new();
    let mut ways: Vec<Vec<i64>> = Vec::new();
    for (first, shape) in (100..).step_by(100).zip(SHAPES) {
        let south = 46.912 + 0.000_055 * f64::from(first);
        for (id, [east, north]) in (i64::from(first) + 1..).zip(PLACES) {
            nodes.push((id, [8.975 + east, south + north]));
        }
        let mut way: Vec<i64> = shape.iter().map(|place| i64::from(first) + place).collect();
        if is_turned {
            way.reverse();
        }
        ways.push(way);
    }
    let ways: Vec<PlainWay<'_>> = ways.iter().map(|way| (&way[..], structure)).collect();
    package_with(folder, name, (&nodes, &ways)).map(|path| text(&path).to_owned())
}

/// Fields by name, of which two change places where a road is turned.
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
        // Vertices of decks that lie on a straight line are left out: the last bits say which these are.
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
    for (carrier, structure) in STRUCTURES {
        let [there, back] = [false, true].map(|is_turned| {
            let name = format!("{carrier}-{is_turned}");
            let [dem, osm, package] = package_of_shapes(folder.path(), &name, structure, is_turned);
            let inputs = ["-O", "--dem", &dem, "--osm", &osm];
            // Without elevation files, way by way, and by chains; whole, and on both sides of a meridian.
            let counts: &[usize] = if structure.is_empty() { &[1, 3, 5] } else { &[5] };
            let all = counts.iter().map(|&count| {
                let bounds = ["-180,-90,180,90", "8.9,46,8.9785,47", "8.9785,46,9.1,47"];
                bounds.map(|bounds| {
                    let target = folder.path().join("roads.gpkg");
                    let options = [&inputs[..count], &["--bounds", bounds]].concat();
                    succeed(export(Path::new(&package), "roads", &target, &options));
                    features(&target)
                })
            });
            all.collect::<Vec<_>>()
        });
        for (there, back) in there.into_iter().flatten().zip(back.into_iter().flatten()) {
            assert_eq!(there.len(), SHAPES.len());
            assert_eq!(there.len(), back.len());
            for ((found, lines), (expected, expected_lines)) in there.iter().zip(&back) {
                are_alike(found, expected, turned);
                // Heights come in the same order, the other way around.
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
}

#[test]
fn edges_of_turned_ways_are_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let [there, back] = [false, true].map(|is_turned| -> Vec<Row> {
        let name = is_turned.to_string();
        let [dem, osm, package] = package_of_shapes(folder.path(), &name, "", is_turned);
        let target = folder.path().join(format!("{name}.csv"));
        let inputs = ["--dem", &dem, "--osm", &osm];
        succeed(export(Path::new(&package), "edges", &target, &inputs));
        features(&target).into_iter().map(|(row, _)| row).collect()
    });
    assert_eq!(there.len(), back.len());
    for (found, expected) in there.iter().zip(&back) {
        let own: Vec<&str> = found["ways"].split(' ').collect();
        assert_eq!(own.len(), expected["ways"].split(' ').count(), "{found:?}");
        let without_ways = |row: &Row| {
            let mut row = row.clone();
            row.remove("ways");
            row
        };
        are_alike(&without_ways(found), &without_ways(expected), |name| name);
    }
}

/// Profiles along a way that was turned, and along one there and back, have the smooth line and the decks of chains in both directions.
#[test]
fn profiles_there_and_back_are_mirrored() {
    let folder = tempfile::tempdir().unwrap();
    for (carrier, structure) in STRUCTURES {
        let [dem, osm, package] = package_of_shapes(folder.path(), carrier, structure, false);
        let run =
            |ways: &str| profile(Path::new(&package), ways, &["--dem", &dem, "--osm", &osm]).0;
        let mut measured = 0;
        for (way, shape) in (1..).zip(SHAPES) {
            let there = run(&way.to_string());
            let both = run(&format!("{way},{way}"));
            let source = &there[0]["height_source"];
            assert!(both.iter().all(|row| row["height_source"] == *source), "{way}: {shape:?}");
            if source == "ground_under_bridge" {
                continue;
            }
            measured += 1;
            // A way that ends where it begins is followed twice in its direction, the others there and back.
            let is_closed = shape.first() == shape.last();
            let heights = |rows: &[Row], name: &str| -> Vec<f64> {
                rows.iter().map(|row| number(row, name)).collect()
            };
            for name in ["height_m", "smooth_m"] {
                let own = heights(&there, name);
                let mut second = own.clone();
                if !is_closed {
                    second.reverse();
                }
                let expected: Vec<f64> = own.iter().chain(second.iter().skip(1)).copied().collect();
                let found = heights(&both, name);
                assert_eq!(found.len(), expected.len(), "{name} {shape:?}");
                for (found, expected) in found.iter().zip(&expected) {
                    assert!((found - expected).abs() < 0.002, "{name} {shape:?}");
                }
            }
        }
        // Bridges to and fro without an end of their own are carried by nothing, and stay on the ground.
        assert_eq!(measured, if structure.is_empty() { 8 } else { 4 });
    }
}
