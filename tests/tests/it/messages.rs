//! The messages of the program and their readers: closed pipes, silence, records, widths of tables;
//! and invalid file names.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, io, path::Path, process::Command};

use e2e::{Ran, binary, copy_pass, corniche, draw, json, lacks_adapter, sample, text};
use serde_json::Value;

/// Runs the binary with closed pipes: standard output, standard error, or both.
fn unread(arguments: &[&str], streams: [bool; 2]) -> Ran {
    let closed = || {
        let (reader, writer) = io::pipe().unwrap();
        drop(reader);
        writer
    };
    let mut command = Command::new(binary());
    command.args(arguments);
    if streams[0] {
        command.stdout(closed());
    }
    if streams[1] {
        command.stderr(closed());
    }
    command.output().unwrap().into()
}

const BOTH: [bool; 2] = [true, true];

/// `corniche … 2>&1 | head`: the reader has gone, but the work is done.
#[test]
fn a_closed_pipe_is_no_failure_and_ends_no_work() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let build = [
        "build",
        "--dem",
        text(&dem),
        "--osm",
        text(&osm),
        "-o",
        text(&package),
        "--max-error",
        "10",
    ];
    for (streams, options) in [
        (BOTH, &[][..]),
        ([false, true], &["-O", "--json-progress"]),
        (BOTH, &["-O", "-vv", "--log-format", "json"]),
    ] {
        let ran = unread(&[&build[..], options].concat(), streams);
        assert_eq!(ran.code, 0, "{options:?}: {}", ran.err);
        assert_eq!(json(&["verify", text(&package), "--json", "-q"])["holds"], true);
        fs::write(&package, b"old").unwrap();
    }
    let ran = unread(&[&build[..], &["-O"]].concat(), BOTH);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let package = text(&package);
    let png = folder.path().join("a.png");
    let lines: [(&[&str], &[i32]); 9] = [
        (&["info", package], &[0]),
        (&["info", package, "--json"], &[0]),
        (&["growth", package], &[0]),
        (&["tile", package, "0/0/0", "--json"], &[0]),
        (&["verify", package], &[0]),
        (&["plan", "--dem", text(&dem)], &[0]),
        (&["build", "--help"], &[0]),
        (&["info", "/nowhere.pmtiles"], &[2]),
        // Without a GPU adapter.
        (&["render", package, "-o", text(&png), "--size", "64x48"], &[0, 1]),
    ];
    for (line, codes) in lines {
        for streams in [[true, false], BOTH] {
            let ran = unread(line, streams);
            assert!(codes.contains(&ran.code), "{line:?}: {} {}", ran.code, ran.err);
            assert!(!ran.err.contains("panicked"), "{line:?}: {}", ran.err);
            let _ = fs::remove_file(&png);
        }
    }
}

/// The requested result is printed, and nothing else.
#[test]
fn silence_leaves_the_answer_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q", "--max-error", "10"]);
    let [dem, plan] = [sample("pass/pass-dem.tif"), folder.path().join("plan.json")];
    let [png, csv, store] = ["a.png", "a.csv", "store"].map(|name| folder.path().join(name));
    let package = text(&package);
    let lines: [&[&str]; 9] = [
        &["info", package, "-q"],
        &["-q", "growth", package],
        &["tile", package, "0/0/0", "-q"],
        &["verify", package, "-q"],
        &["plan", "--dem", text(&dem), "-q", "-o", text(&plan)],
        &["jobs", text(&plan), "--slots", "2", "-q"],
        &["part", text(&plan), "--store", text(&store), "--step", "hashes", "-q"],
        &["render", package, "-o", text(&png), "--size", "64x48", "-q"],
        &[
            "fly",
            package,
            "-o",
            text(&csv),
            "--size",
            "64x48",
            "--frames",
            "2",
            "--lod",
            "culled",
            "-q",
        ],
    ];
    for line in lines {
        let ran = corniche(line);
        if ["render", "fly"].contains(&line[0]) && lacks_adapter(&ran) {
            continue;
        }
        // Libraries are silent, too, where there is no display.
        assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{line:?}");
        assert_eq!(ran.out.is_empty(), line[0] == "render", "{line:?}");
    }
    let ran = corniche(["info", "/nowhere.pmtiles", "-q"]);
    assert!(ran.code == 2 && ran.err.starts_with("corniche: "), "{}", ran.err);
}

/// Programs that read a pipe get plain digits; the tables fit on a terminal of 100 columns.
#[test]
fn numbers_are_plain_in_pipes_and_tables_are_narrow() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let built = corniche(["build", "--dem", text(&dem), "--osm", text(&osm), "-o", text(&package)]);
    assert_eq!(built.code, 0, "{}", built.err);
    let [info, growth] = ["info", "growth"].map(|command| corniche([command, text(&package)]).out);
    let verify = corniche(["verify", text(&package), "--dem", text(&dem)]).out;
    let plan = corniche(["plan", "--dem", text(&dem), "--osm", text(&osm)]).out;
    for said in [&built.err, &info, &growth, &verify, &plan] {
        assert!(!said.contains('\u{202f}'), "{said}");
    }
    let manifest = json(&["info", text(&package), "--json"])["manifest"].take();
    let triangles = manifest["levels"].as_array().unwrap().last().unwrap()["triangles"].to_string();
    assert!(triangles.len() > 5 && info.contains(&format!(" {triangles} ")), "{triangles}: {info}");
    // Texts are folded, too, except for longer words.
    let wide = info.lines().filter(|line| line.chars().count() > 100);
    assert_eq!(wide.collect::<Vec<_>>(), Vec::<&str>::new(), "{info}");
    for said in [&built.err, &info, &growth, &verify, &plan] {
        // Tables begin after the first empty line.
        let tables = said.lines().skip_while(|line| !line.is_empty());
        let is_table =
            |line: &&str| line.trim().split("  ").filter(|cell| !cell.is_empty()).count() > 3;
        for line in tables.filter(is_table) {
            assert!(line.chars().count() <= 100, "{}: {line}", line.chars().count());
        }
    }
}

/// Classes are parts of the read roads, so they are listed below those and not below the lost ones.
#[test]
fn classes_stand_under_what_they_break_down() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q", "--max-error", "10"]);
    let info = corniche(["info", text(&package)]).out;
    let lines: Vec<&str> = info.lines().collect();
    let read = lines.iter().position(|line| line.starts_with("read ")).unwrap();
    let count = |line: &str| -> u64 {
        line.split("  ")
            .filter(|cell| !cell.trim().is_empty())
            .nth(1)
            .unwrap()
            .trim()
            .parse()
            .unwrap()
    };
    let classes: Vec<&&str> =
        lines[read + 1..].iter().take_while(|line| line.starts_with("  FRC ")).collect();
    assert!(classes.len() >= 8, "{info}");
    assert_eq!(
        classes.iter().map(|line| count(line.trim_start())).sum::<u64>(),
        count(lines[read])
    );
    assert!(lines[read + 1 + classes.len()].starts_with("kept: "), "{info}");
}

fn records(said: &str) -> Vec<Value> {
    let parse = |line| serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}"));
    said.lines().map(parse).collect()
}

/// An invalid command line: readers of records get a record, with the same exit code.
#[test]
fn refused_command_lines_are_records_on_request() {
    let lines: [(&[&str], &str); 5] = [
        (&["info", "a.pmtiles", "--odd"], "--odd"),
        (&["build"], "--dem"),
        (&["nothing"], "nothing"),
        (&["build", "--dem", "a.tif", "-o", "b.pmtiles", "--max-error"], "--max-error"),
        (&["info", "a.pmtiles", "-q", "-v"], "cannot be used with"),
    ];
    for (line, word) in lines {
        let plain = corniche(line);
        assert!(plain.code == 2 && plain.err.starts_with("error: "), "{line:?}: {}", plain.err);
        for format in [&["--log-format", "json"][..], &["--log-format=json"]] {
            let ran = corniche([format, line].concat());
            let [record] = &records(&ran.err)[..] else { panic!("{line:?}: {}", ran.err) };
            let message = record["message"].as_str().unwrap();
            assert!(ran.code == 2 && ran.out.is_empty(), "{line:?}: {}", ran.code);
            assert_eq!((&record["level"], &record["exit_code"]), (&"ERROR".into(), &2.into()));
            assert!(message.contains(word) && !message.contains("Usage"), "{message}");
        }
        let ran = corniche([line, &["--json-progress"]].concat());
        let [record] = &records(&ran.err)[..] else { panic!("{line:?}: {}", ran.err) };
        let end = &record["end"];
        assert_eq!((&end["result"], &end["exit_code"]), (&"unusable".into(), &2.into()), "{end}");
        assert!(ran.code == 2 && end["error"].is_string(), "{end}");
    }
    // Silence and records exclude each other in every order.
    let dem = sample("pass/pass-dem.tif");
    let build = ["build", "--dem", text(&dem), "-o", "/nowhere/a.pmtiles", "--json-progress"];
    for line in [[&["-q"], &build[..]].concat(), [&build[..], &["-q"]].concat()] {
        let ran = corniche(&line);
        let [record] = &records(&ran.err)[..] else { panic!("{line:?}: {}", ran.err) };
        let error = record["end"]["error"].as_str().unwrap();
        assert!(ran.code == 2 && error.contains("--quiet"), "{line:?}: {error}");
    }
    // Help is a result.
    let help = corniche(["build", "--help", "--log-format", "json"]);
    assert!(help.code == 0 && help.err.is_empty() && help.out.contains("--dem"));
}

#[test]
fn messages_are_records_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let build = [
        "build",
        "--dem",
        text(&dem),
        "--osm",
        text(&osm),
        "-o",
        text(&package),
        "--max-error",
        "10",
    ];
    let run =
        |options: &[&str]| corniche([&build[..], &["--log-format", "json"], options].concat());
    let ran = run(&[]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let told = records(&ran.err);
    for record in &told {
        assert_eq!(record["level"], "INFO", "{record}");
        assert!(record["timestamp"].is_string() && record["message"].is_string(), "{record}");
    }
    let stage = told.iter().find(|record| record["span"]["id"] == "tiles").unwrap();
    assert!(stage["done"].as_u64() > Some(0) && stage["seconds"].as_f64().is_some(), "{stage}");
    // More messages with -v, still as records; a target that exists is an error with its exit code.
    let ran = run(&["-v"]);
    assert_eq!(ran.code, 3, "{}", ran.err);
    let told = records(&ran.err);
    assert!(told.iter().any(|record| record["level"] == "DEBUG"), "{}", ran.err);
    let error = told.last().unwrap();
    assert_eq!((&error["level"], &error["exit_code"]), (&"ERROR".into(), &3.into()), "{error}");
    assert!(error["message"].as_str().unwrap().contains("pass.pmtiles"), "{error}");
    assert_eq!(error["span"]["command"], "build", "{error}");
    let loud = run(&["-vv", "-O"]);
    assert_eq!(loud.code, 0, "{}", loud.err);
    assert!(records(&loud.err).iter().any(|record| record["level"] == "TRACE"));
}

/// Warnings, errors and the end are records, too, whenever the run fails.
#[test]
fn progress_in_records_ends_with_how_it_ended() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("a.pmtiles");
    let dem = sample("pass/pass-dem.tif");
    let lines: [(&[&str], i32, &str, &str); 4] = [
        (&["build", "--dem", "/nowhere.tif", "-o", text(&package)], 2, "unusable", "/nowhere.tif"),
        (&["build", "--dem", text(&dem), "-o", "-"], 2, "unusable", "standard output"),
        (
            &["merge", "/nowhere.json", "--store", "s", "-o", text(&package)],
            2,
            "unusable",
            "nowhere",
        ),
        (&["verify", "/nowhere.pmtiles"], 2, "unusable", "nowhere"),
    ];
    for (line, code, result, word) in lines {
        let ran = corniche(line.iter().chain(&["--json-progress"]));
        assert_eq!(ran.code, code, "{line:?}: {}", ran.err);
        let told = records(&ran.err);
        let end = &told.last().unwrap()["end"];
        assert_eq!(
            (&end["result"], &end["exit_code"]),
            (&result.into(), &code.into()),
            "{line:?}: {end}"
        );
        assert!(end["error"].as_str().unwrap().contains(word), "{line:?}: {end}");
    }
}

#[test]
fn the_version_tells_what_a_report_should_name() {
    let long = corniche(["--version"]).out;
    let lines: Vec<&str> = long.lines().collect();
    assert!(lines[0].starts_with("corniche ") && lines.len() == 5, "{long}");
    assert!(lines[1].starts_with("GDAL ") && lines[1].contains("PROJ "), "{long}");
    assert_eq!(lines[2], "formats: package 2, plan 11, store 1");
    assert_eq!(lines[3], "inputs: all of the manual");
    assert!(lines[4].starts_with("wgpu backends: ") && lines[4].contains("vulkan"), "{long}");
    assert_eq!(corniche(["-V"]).out, format!("{}\n", lines[0]));
}

/// `-`, URLs, and package names with another extension are rejected.
#[test]
fn names_that_no_file_should_have_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q", "--max-error", "10"]);
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let plan = folder.path().join("plan.json");
    assert_eq!(corniche(["plan", "--dem", text(&dem), "-o", text(&plan)]).code, 0);
    let (package, plan) = (text(&package), text(&plan));
    let build = ["build", "--dem", text(&dem), "-o"];
    let merge = ["merge", plan, "--store", text(folder.path()), "-o"];
    let lines: [(&[&str], &[&str], &str); 12] = [
        (&build, &["-"], "standard output"),
        (&build, &["out.tif"], "out.tif.pmtiles"),
        (&build, &["s3://bucket/out.pmtiles"], "corniche merge"),
        (&build, &["ok.pmtiles", "--osm", text(&osm), "--defects", "-"], "standard output"),
        (&merge, &["-"], "standard output"),
        (&merge, &["out"], "out.pmtiles"),
        (&merge, &["s3://bucket/out"], "s3://bucket/out.pmtiles"),
        (&["plan", "--dem", text(&dem), "-o"], &["-"], "standard output"),
        (&["render", package, "-o"], &["-"], "standard output"),
        (&["growth", package, "--svg"], &["-"], "standard output"),
        (&["fly", package, "-o"], &["-"], "standard output"),
        (&["fly", package, "-o", "a.csv", "--png"], &["-"], "standard output"),
    ];
    for (command, rest, word) in lines {
        let ran =
            Command::new(binary()).args(command).args(rest).current_dir(&folder).output().unwrap();
        let ran = Ran::from(ran);
        assert_eq!(ran.code, 2, "{command:?} {rest:?}: {}", ran.err);
        assert!(ran.err.contains(word), "{command:?} {rest:?}: {}", ran.err);
    }
    let mut names: Vec<_> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["pass.pmtiles", "plan.json"]);
}

/// Images and charts are kept like packages, unless `-O` is given.
#[test]
fn pictures_and_charts_are_replaced_only_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q", "--max-error", "10"]);
    let [png, svg] = ["a.png", "a.svg"].map(|name| folder.path().join(name));
    for file in [&png, &svg] {
        fs::write(file, b"precious").unwrap();
    }
    let growth = ["growth", text(&package), "--svg", text(&svg)];
    let keeps = |ran: &Ran, file: &Path| {
        assert_eq!(ran.code, 3, "{}", ran.err);
        assert!(ran.err.contains("-O") && ran.err.contains(text(file)), "{}", ran.err);
        assert_eq!(fs::read(file).unwrap(), b"precious");
    };
    keeps(&corniche(growth), &svg);
    keeps(&corniche(["render", text(&package), "-o", text(&png), "--size", "64x48"]), &png);
    let ran = corniche(growth.iter().chain(&["-O"]));
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(fs::read_to_string(&svg).unwrap().contains("<svg"));
    if let Some(ran) = draw("render", &package, &png, &["-O", "--size", "64x48"]) {
        assert_eq!(ran.code, 0, "{}", ran.err);
        assert_eq!(&fs::read(&png).unwrap()[..4], b"\x89PNG");
    }
}
