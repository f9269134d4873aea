//! Messages of a build while it runs, and, with `-v`, the table at its end.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use e2e::{Ran, copy_pass, corniche, sample, text};
use serde_json::Value;

/// Builds the sample `pass` and returns its messages.
fn build(options: &[&str]) -> Ran {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let line = ["build", "--dem", text(&dem), "--osm", text(&osm), "-o", text(&package)];
    let ran = corniche(line.iter().chain(options));
    assert_eq!(ran.code, 0, "{}", ran.err);
    ran
}

/// Every line is JSON; the number of done units grows and never exceeds the total; each stage
/// begins, runs and ends.
#[test]
fn json_lines_tell_what_is_done_of_what() {
    // With a fine tolerance and one thread, stages take long enough to be reported while they run.
    let ran = build(&["--json-progress", "--max-error", "0.5", "--threads", "1"]);
    let mut lines: Vec<Value> =
        ran.err.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let end = lines.pop().unwrap()["end"].take();
    assert_eq!((&end["result"], &end["exit_code"]), (&"done".into(), &0.into()), "{end}");
    assert!(end["error"].is_null() && end["seconds"].as_f64() > Some(0.0), "{end}");
    let summary = lines.pop().unwrap();
    let mut begun: Vec<&str> = Vec::new();
    let mut before: Option<&Value> = None;
    for line in &lines {
        let number = |line: &Value, name: &str| line[name].as_f64();
        let done = number(line, "done").unwrap_or_else(|| panic!("{line}"));
        let total = number(line, "total").unwrap_or(f64::INFINITY);
        assert!(done <= total && number(line, "already") == Some(0.0), "{line}");
        match (line["state"].as_str().unwrap(), before.take()) {
            ("begin", None) => {
                begun.push(line["stage"].as_str().unwrap());
                assert!(line["title"].as_str().unwrap().len() > 5, "{line}");
                assert_eq!(line["done"], 0, "{line}");
            }
            (state @ ("running" | "end"), Some(before)) => {
                assert_eq!(line["stage"], before["stage"], "{before} {line}");
                assert!(done >= number(before, "done").unwrap(), "{before} {line}");
                assert!(number(line, "seconds") >= number(before, "seconds"), "{before} {line}");
                if state == "end" && total.is_finite() {
                    assert_eq!((done, number(line, "seconds_left")), (total, Some(0.0)), "{line}");
                }
                let has_rate = number(line, "per_second").is_some_and(|rate| rate > 0.0);
                assert_eq!(has_rate, done > 0.0, "{line}");
            }
            _ => panic!("out of order: {line}"),
        }
        before = (line["state"] != "end").then_some(line);
    }
    assert!(before.is_none() && lines.iter().any(|line| line["state"] == "running"), "{}", ran.err);
    assert_eq!((begun[0], *begun.last().unwrap()), ("hash", "package"));
    let hash = lines.iter().find(|line| line["state"] == "end").unwrap();
    assert_eq!(hash["unit"], "bytes");

    let rows = summary["summary"].as_array().unwrap();
    let named: Vec<&str> = rows.iter().map(|row| row["stage"].as_str().unwrap()).collect();
    assert_eq!(named, begun, "the summary has each stage once, in order");
    let seconds = |row: &Value| row["seconds"].as_f64().unwrap();
    assert!(rows.iter().map(seconds).sum::<f64>() <= seconds(&summary["all"]), "{summary}");
    if cfg!(target_os = "linux") {
        check_what_linux_tells(rows, &summary["all"], hash["done"].as_u64().unwrap());
    }
}

fn check_what_linux_tells(rows: &[Value], all: &Value, input_bytes: u64) {
    let mut peak_bytes = 1;
    for row in rows.iter().chain([all]) {
        let number = |name: &str| row[name].as_u64().unwrap_or_else(|| panic!("{name}: {row}"));
        assert!(number("peak_memory_bytes") >= peak_bytes, "{row}");
        peak_bytes = number("peak_memory_bytes");
        assert!(row["cpu_seconds"].as_f64().unwrap() >= 0.0, "{row}");
        let is_long = row["seconds"].as_f64().unwrap() >= 0.2;
        assert_eq!(row["cores_busy"].is_number(), is_long, "{row}");
        if row["stage"] == "hash" {
            assert!(number("read_bytes") >= input_bytes, "{row}");
        }
        if row["stage"] == "package" {
            assert!(number("written_bytes") > 0, "{row}");
        }
    }
}

/// Without a terminal: a line per stage when it ends, and with `-v` the table at the end.
#[test]
fn plain_lines_end_with_the_table() {
    let ran = build(&["-v"]);
    let lines: Vec<&str> = ran.err.lines().filter(|line| !line.starts_with("debug: ")).collect();
    let heading = lines.iter().position(|line| line.starts_with("stage ")).unwrap();
    let words = ["done", "wall", "CPU", "cores", "rate", "memory", "read", "written"];
    let known = if cfg!(target_os = "linux") { &words[..] } else { &words[..2] };
    // A table that is too wide continues below, with the same rows.
    let blocks: Vec<&[&str]> = lines[heading..].split(|line| line.is_empty()).collect();
    let headings: String = blocks.iter().map(|block| block[0]).collect();
    assert!(known.iter().all(|word| headings.contains(word)), "{}", ran.err);
    let rows = &blocks[0][1..];
    assert!(blocks.iter().all(|block| block.len() == rows.len() + 1), "{}", ran.err);
    assert!(rows.last().unwrap().starts_with("all "), "{}", ran.err);
    // Each stage had its line before, with the same title.
    for row in &rows[..rows.len() - 1] {
        let title = row.split("  ").next().unwrap();
        let told = lines[..heading].iter().filter(|line| line.starts_with(title)).count();
        assert!(told >= 1, "{title}: {}", ran.err);
    }
    assert!(rows.len() >= 6, "{}", ran.err);
    assert!(lines[0].starts_with("hashing inputs") && lines[0].contains("B in "), "{}", ran.err);
}

#[test]
fn nothing_is_told_to_whoever_asks_for_silence() {
    assert_eq!(build(&["--quiet"]).err, "");
}

/// Every export, `match` and `verify`: records in which each stage begins, counts up to its total
/// and ends, and plain lines without a terminal.
#[test]
fn exports_and_comparisons_tell_how_far_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet", "--max-error", "20"]);
    let package = text(&package);
    let export = |what: &'static str, name: &str, more: &[&'static str]| {
        let words = ["export", what, package, "-O", "-o"].map(str::to_owned);
        let target = text(&folder.path().join(name)).to_owned();
        let words: Vec<String> = words.into_iter().chain([target]).collect();
        words.into_iter().chain(more.iter().map(|&word| word.to_owned())).collect::<Vec<_>>()
    };
    let as_is = ["--heights", "as-is"];
    for (line, stages) in [
        (export("roads", "a.csv", &[]), &["export-tiles", "export-features"][..]),
        (export("mesh", "a.glb", &["--level", "1"]), &["export-tiles"]),
        (export("geotiff", "a.tif", &["--level", "0"]), &["export-blocks"]),
        (
            export("3dtiles", "tiles", &[&as_is[..], &["--finest-level", "0"]].concat()),
            &["export-tiles"],
        ),
        (
            export("quantized-mesh", "mesh", &[&as_is[..], &["--max-level", "8"]].concat()),
            &["export-tiles"],
        ),
        (["match", package, "--slope"].map(str::to_owned).to_vec(), &["match"]),
        (["verify", package].map(str::to_owned).to_vec(), &["verify"]),
    ] {
        let ran = corniche(line.iter().map(String::as_str).chain(["--json-progress"]));
        assert_eq!(ran.code, 0, "{line:?}: {}", ran.err);
        let records: Vec<Value> =
            ran.err.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        for stage in stages {
            let own: Vec<&Value> =
                records.iter().filter(|record| record["stage"] == *stage).collect();
            let states: Vec<&str> =
                own.iter().map(|record| record["state"].as_str().unwrap()).collect();
            assert!(states.len() >= 2 && states[0] == "begin", "{line:?}: {states:?}");
            let last = own.last().unwrap();
            assert_eq!((&last["state"], &last["done"]), (&"end".into(), &last["total"]), "{last}");
            assert!(last["total"].as_u64() > Some(0), "{last}");
            assert!(own.iter().all(|record| record.get("seconds_left").is_some()), "{last}");
        }
        assert_eq!(records.last().unwrap()["end"]["result"], "done");
        // One of them is enough, because all report through one observer.
        if line[1] != "roads" && line[0] != "match" {
            continue;
        }
        let ran = corniche(&line);
        assert!(
            ran.err.lines().any(|line| line.contains(" in ") && line.contains(" s")),
            "{}",
            ran.err
        );
        let silent = corniche(line.iter().map(String::as_str).chain(["--quiet"]));
        assert_eq!(silent.err, "", "{line:?}");
    }
}
