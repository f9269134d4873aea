//! `corniche profile`: height and grade along ways, compared with the export.

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
    e2e::copy_pass(&package, &["--max-error", "2"]);
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
        // Bridges and tunnels have no ascents and descents of their own.
        if field("ascent_m").is_none() {
            continue;
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
        // The list has millimetres.
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
            // Grades of vertices are over twenty metres, and the steepest of the whole is over at
            // least that.
            assert!(most <= steepest + 0.01, "{way}: {most} {steepest}");
            assert!(said.contains(&format!("Steepest {steepest:.1} %")), "{said}");
        }
        assert!(fs::read_to_string(&chart).unwrap().contains("OpenStreetMap contributors"));
    }
    assert_eq!(checked, 12);
}

/// A way of the package as a line of a file: the same ground, the same heights.
#[test]
fn a_line_of_a_file_has_the_profile_of_the_way_that_it_follows() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (package, roads, line) = (at("pass.pmtiles"), at("roads.gpkg"), at("line.gpkg"));
    e2e::copy_pass(&package, &["--max-error", "2"]);
    succeed(corniche(["export", "roads", text(&package), "-o", text(&roads), "-q"]));
    let longest = {
        let dataset = gdal::Dataset::open(&roads).unwrap();
        let mut layer = dataset.layer(0).unwrap();
        let field = |feature: &gdal::vector::Feature<'_>, name: &str| {
            feature.field_as_double(feature.field_index(name).unwrap()).unwrap().unwrap()
        };
        let whole =
            layer.features().filter(|feature| feature.geometry().unwrap().geometry_count() < 2);
        let lengths = whole.map(|way| (field(&way, "length_2d_m"), field(&way, "way_id") as i64));
        lengths.max_by(|one, other| one.0.total_cmp(&other.0)).unwrap().1.to_string()
    };
    let cut = std::process::Command::new("ogr2ogr")
        .args(["-dim", "XY", "-where", &format!("way_id = {longest}")])
        .args([&line, &roads])
        .arg("roads")
        .output()
        .unwrap();
    assert!(cut.status.success(), "{}", String::from_utf8_lossy(&cut.stderr));
    let profile = |what: &[&str], name: &str| {
        let list = at(name);
        let words = [&["profile", text(&package), "--csv", text(&list)], what].concat();
        let said = succeed(corniche(words)).out;
        (rows(&fs::read_to_string(list).unwrap()), said)
    };
    let (of_way, said) = profile(&["--way", &longest], "way.csv");
    let (of_line, also_said) = profile(&["--line", text(&line)], "line.csv");
    assert!(of_way.len() > 50, "{} vertices", of_way.len());
    let last = |rows: &[BTreeMap<String, String>], name| number(rows.last().unwrap(), name);
    for name in ["distance_m", "height_m"] {
        let (one, other) = (last(&of_way, name), last(&of_line, name));
        assert!((one - other).abs() < 0.05, "{name}: {one} and {other}");
    }
    assert!(of_line.iter().all(|row| row["way_id"] == "1" && row["part"] == "0"));
    let length = |said: &str| said.lines().next().unwrap().split(" m").next().unwrap().to_owned();
    assert_eq!(length(&said), length(&also_said));
    let far = at("far.geojson");
    fs::write(&far, r#"{"type":"LineString","coordinates":[[100,10],[101,11]]}"#).unwrap();
    let ran = corniche(["profile", text(&package), "--line", text(&far)]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("no line crosses the ground"), "{}", ran.err);
    let both = corniche(["profile", text(&package), "--line", text(&far), "--way", "1"]);
    assert_eq!(both.code, 2, "{}", both.err);
}

#[test]
fn what_is_not_there_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    e2e::copy_pass(&package, &["--max-error", "10"]);
    let ran = corniche(["profile", text(&package), "--way", "101,-5"]);
    assert!(ran.code == 2 && ran.err.contains("has no way -5 on level"), "{}", ran.err);
    let ran = corniche(["profile", text(&package), "--way", "101", "--level", "30"]);
    assert!(ran.code == 2 && ran.err.contains("has no level 30"), "{}", ran.err);
    let list = folder.path().join("list.csv");
    fs::write(&list, "mine").unwrap();
    let ran = corniche(["profile", text(&package), "--way", "101", "--csv", text(&list)]);
    assert_eq!((ran.code, fs::read_to_string(&list).unwrap().as_str()), (3, "mine"), "{}", ran.err);
}
