//! `corniche profile`: height and grade along ways, beside what the export says of them.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{collections::BTreeMap, fs};

use e2e::{Ran, corniche, text};
use gdal::vector::LayerAccess as _;

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran
}

/// Rows of a CSV without quoted fields, by the names of their columns.
fn rows(text: &str) -> Vec<BTreeMap<String, String>> {
    let mut lines = text.lines();
    let names: Vec<String> = lines.next().unwrap().split(',').map(str::to_owned).collect();
    let row = |line: &str| names.iter().cloned().zip(line.split(',').map(str::to_owned)).collect();
    lines.map(row).collect()
}

fn number(row: &BTreeMap<String, String>, name: &str) -> f64 {
    row[name].parse().unwrap_or_else(|_| panic!("{name}: {row:?}"))
}

#[test]
fn a_profile_is_as_long_and_as_steep_as_the_exported_road() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (package, list, chart) = (at("pass.pmtiles"), at("profile.csv"), at("profile.svg"));
    e2e::build_pass(&package, &["--max-error", "2"]);
    let dataset = {
        let roads = at("roads.gpkg");
        succeed(corniche(["export", "roads", text(&package), "-o", text(&roads), "-q"]));
        gdal::Dataset::open(&roads).unwrap()
    };
    let mut layer = dataset.layer(0).unwrap();
    let mut checked = 0;
    for feature in layer.features() {
        let field = |name: &str| {
            let index = feature.field_index(name).unwrap();
            feature.field_as_double(index).unwrap()
        };
        let way_id = field("way_id").unwrap() as i64;
        if checked == 12 {
            break;
        }
        checked += 1;
        let way = way_id.to_string();
        let words = ["profile", text(&package), "--way", &way, "-O", "--csv", text(&list)];
        let said = succeed(corniche([&words[..], &["--svg", text(&chart)]].concat())).out;
        let rows = rows(&fs::read_to_string(&list).unwrap());
        let steps = rows.array_windows::<2>().filter(|[from, to]| from["part"] == to["part"]);
        let rises: Vec<f64> =
            steps.map(|[from, to]| number(to, "height_m") - number(from, "height_m")).collect();
        let up: f64 = rises.iter().filter(|rise| **rise > 0.0).sum();
        // Millimetres in the list.
        let close = |found: f64, expected: f64| {
            assert!(
                (found - expected).abs() < 2e-3 * rows.len() as f64,
                "{way}: {found} {expected}"
            );
        };
        close(number(rows.last().unwrap(), "distance_m"), field("length_2d_m").unwrap());
        close(up, field("ascent_m").unwrap());
        if let Some(steepest) = field("steepest_pct") {
            let most = rows.iter().map(|row| number(row, "grade_pct").abs()).fold(0.0, f64::max);
            // Grades of vertices are over twenty metres, and the steepest of all is over as much or more.
            assert!(most <= steepest + 0.01, "{way}: {most} {steepest}");
            assert!(said.contains(&format!("Steepest {steepest:.1} %")), "{said}");
        }
        assert!(fs::read_to_string(&chart).unwrap().contains("OpenStreetMap contributors"));
    }
    assert_eq!(checked, 12);
}

#[test]
fn what_is_not_there_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    e2e::build_pass(&package, &["--max-error", "10"]);
    let ran = corniche(["profile", text(&package), "--way", "101,-5"]);
    assert!(ran.code == 2 && ran.err.contains("has no way -5 on level"), "{}", ran.err);
    let ran = corniche(["profile", text(&package), "--way", "101", "--level", "30"]);
    assert!(ran.code == 2 && ran.err.contains("has no level 30"), "{}", ran.err);
    let list = folder.path().join("list.csv");
    fs::write(&list, "mine").unwrap();
    let ran = corniche(["profile", text(&package), "--way", "101", "--csv", text(&list)]);
    assert_eq!((ran.code, fs::read_to_string(&list).unwrap().as_str()), (3, "mine"), "{}", ran.err);
}
