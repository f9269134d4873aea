//! The summary at the end of a build: a few lines for people; with `-v` everything that `info`
//! prints. Records are unchanged.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::fs;

use e2e::{corniche, json, root, sample, text};
use serde_json::Value;

/// The largest number of lines.
const MOST_LINES: usize = 10;

#[test]
fn a_build_ends_with_a_verdict_and_tells_the_rest_with_v() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let line = ["build", "--dem", text(&dem), "--osm", text(&osm), "-O", "-o", text(&package)];
    let options = ["--max-error", "10", "--layers", "areas", "--classes", "0-4"];
    let build = |more: &[&str]| {
        let ran = corniche([&line[..], &options[..], more].concat());
        assert_eq!(ran.code, 0, "{}", ran.err);
        ran.err
    };
    let said = build(&[]);
    let (_, verdict) = said.split_once("\n\n").unwrap();
    let lines: Vec<&str> = verdict.lines().collect();
    assert!(lines.len() <= MOST_LINES, "{said}");
    let (_, told) = lines.split_last().unwrap();
    assert!(told.iter().all(|line| line.chars().count() <= 100), "{said}");
    let info = json(&["info", text(&package), "--json"]);
    let counts = &info["manifest"]["counts"];
    let km = |um: &Value| format!("{:.1} km", um.as_f64().unwrap() / 1e9);
    let roads = format!(
        "roads        {} of {} kept, {} of {}",
        counts["roads_kept"],
        counts["roads_in"],
        km(&counts["roads_kept_um"]),
        km(&counts["roads_in_um"])
    );
    assert_eq!(lines[0], roads);
    for begin in
        ["skipped ", "areas ", "datum        vertical datum unknown; ", "error ", "size ", "wrote "]
    {
        assert!(lines.iter().any(|line| line.starts_with(begin)), "{begin}: {said}");
    }
    assert!(verdict.contains("class is off"), "{said}");
    assert!(verdict.contains("; --classes 0-8 includes them\n"), "{said}");
    assert!(lines.last().unwrap().contains(text(&package)), "{said}");

    // With -v, everything that info prints.
    let detailed = build(&["-v"]);
    let told = corniche(["info", text(&package)]).out;
    assert!(told.lines().count() > 40, "{told}");
    for line in told.lines() {
        assert!(detailed.lines().any(|own| own == line), "{line}");
    }
    assert!(detailed.contains(&roads) && detailed.contains("\nstage "), "{detailed}");
    assert!(!said.contains("stage "), "{said}");

    // Records are unchanged.
    let records = build(&["--log-format", "json"]);
    let records: Vec<Value> =
        records.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let of = |words: &str| {
        let has = |record: &&Value| {
            record["message"].as_str().is_some_and(|text| text.starts_with(words))
        };
        records.iter().filter(has).count()
    };
    assert_eq!([of("wrote "), of("all stages"), of("roads  ")], [1, 1, 0], "{records:?}");
}

/// The outline of a surface is neither a road nor a defect.
#[test]
fn an_area_is_told_once_and_as_no_defect() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("li.pmtiles");
    let [dem, osm] = ["liechtenstein-dem.tif", "liechtenstein-2013-08-03.osm.pbf"]
        .map(|name| sample(&format!("liechtenstein/{name}")));
    let line = ["build", "--dem", text(&dem), "--osm", text(&osm), "-q", "-o", text(&package)];
    let quick = ["--max-error", "100", "--relief", "off"];
    assert_eq!(corniche([&line[..], &quick[..]].concat()).code, 0);
    let counts = json(&["info", text(&package), "--json"])["manifest"]["counts"].take();
    let defects = counts["defects"].as_array().unwrap();
    let area = defects.iter().find(|defect| defect["name"] == "area").expect("the sample has one");
    let info = corniche(["info", text(&package)]).out;
    assert!(!info.contains("defect: area"), "{info}");
    assert!(info.contains(&format!("skipped, an area: {}", area["count"])), "{info}");
    let others = ["area", "unknown highway value", "tag taken for another value"];
    let told = defects.iter().filter(|defect| !others.contains(&defect["name"].as_str().unwrap()));
    assert_eq!(info.matches("defect: ").count(), told.count(), "{info}");
}

/// A custom table is not known by its name: the package records the labels of its classes. A copy
/// of a preset is known.
#[test]
fn packages_tell_what_the_classes_of_a_table_of_ones_own_are_called() {
    let folder = tempfile::tempdir().unwrap();
    let [own, package] = ["own.toml", "pass.pmtiles"].map(|name| folder.path().join(name));
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let build = |table: &str| {
        let line = ["build", "--dem", text(&dem), "--osm", text(&osm), "--frc-table", table];
        let rest = ["-q", "-O", "-o", text(&package), "--max-error", "20", "--relief", "off"];
        let ran = corniche([&line[..], &rest[..]].concat());
        assert_eq!(ran.code, 0, "{}", ran.err);
        let settings = json(&["info", text(&package), "--json"])["manifest"]["settings"].take();
        (settings["class_labels"].clone(), fs::read(&package).unwrap())
    };
    let (_, preset) = build("default");
    fs::copy(root().join("config/frc/default.toml"), &own).unwrap();
    let (labels, copy) = build(text(&own));
    assert!(labels.is_null() && copy == preset, "a copy of a preset makes the same bytes");

    let table = "name = \"default\"\nleast_class = 2\nnot_roads = []\n[classes]\nmotorway = 0\nsecondary = 1\ntrack = 1\npath = 2\nvia_ferrata = 7\n";
    fs::write(&own, table).unwrap();
    let (labels, _) = build(text(&own));
    let expected = ["motorway", "secondary, track", "path", "class 3"];
    assert_eq!(labels.as_array().unwrap()[..4], expected.map(Value::from));
    assert_eq!(labels[7], "via ferrata");
    // A plan that is read again is the same.
    let plan = folder.path().join("plan.json");
    let line = ["plan", "--dem", text(&dem), "--osm", text(&osm), "--frc-table", text(&own), "-q"];
    assert_eq!(corniche([&line[..], &["-o", text(&plan)]].concat()).code, 0);
    let ran = corniche(["jobs", text(&plan), "--slots", "1"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let verify = ["verify", text(&package), "--osm", text(&osm), "--frc-table", text(&own), "-q"];
    let ran = corniche(verify);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
}
