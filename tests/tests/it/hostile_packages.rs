//! Every command that reads a malicious package ends within limits of CPU time and memory, and
//! reports the error in one line.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap, and this one prints figures"
)]
#![cfg(target_os = "linux")]

use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
};

use corniche_testing::{
    hostile::{
        COMMANDING, Case, FAMILIES, ReadOutcome, SPAN_ATTACKS, commanding_texts, span_attack,
        text_cases,
    },
    some_of,
};
use e2e::{Costs, Ran, binary, corniche, ended_with_costs, json, text};

/// CPU seconds that a command may use, also with a software driver; then the shell ends it.
const MOST_SECONDS: u32 = 10;
const MOST_MIB: u64 = 1024;

/// The commands: the words before the package's name, and those after. Most of these packages have
/// their tile on level 0 only.
const COMMANDS: [(&str, &[&str], &[&str]); 16] = [
    ("verify", &["verify", "-q"], &[]),
    ("render geo", &["render", "-q", "--size", "200x150", "--roads", "geo"], &["-o", "OUT.png"]),
    ("render sv", &["render", "-q", "--size", "200x150", "--roads", "sv"], &["-o", "OUT.png"]),
    (
        "export roads",
        &["export", "roads", "-q", "--level", "0", "--crs", "EPSG:4979", "--heights", "as-is"],
        &["-o", "OUT.gpkg"],
    ),
    // Without a system for its heights.
    ("export roads plain", &["export", "roads", "-q", "--level", "0"], &["-o", "OUT.gpkg"]),
    ("export line", &["export", "layer", "line", "-q", "--level", "0"], &["-o", "OUT.gpkg"]),
    ("export area", &["export", "layer", "area", "-q", "--level", "0"], &["-o", "OUT.gpkg"]),
    ("export point", &["export", "layer", "point", "-q", "--level", "0"], &["-o", "OUT.gpkg"]),
    ("export mesh", &["export", "mesh", "-q", "--level", "0"], &["-o", "OUT.glb"]),
    ("export tiles3d", &["export", "3dtiles", "-q", "--heights", "as-is"], &["-o", "OUT.tiles"]),
    (
        "export quantized-mesh",
        &["export", "quantized-mesh", "-q", "--heights", "as-is"],
        &["-o", "OUT.terrain"],
    ),
    ("export geotiff", &["export", "geotiff", "-q"], &["-o", "OUT.tif"]),
    ("export geotiff 0", &["export", "geotiff", "-q", "--level", "0"], &["-o", "OUT.tif"]),
    ("info", &["info"], &[]),
    ("growth", &["growth"], &[]),
    ("tile", &["tile", "--json"], &["0/0/0"]),
];

/// Runs a command within the time limit, and returns the resources that it used.
fn run(
    folder: &Path,
    package: &Path,
    (_, before, after): (&str, &[&str], &[&str]),
) -> (Ran, Costs) {
    let out = folder.join("out");
    let after = after.iter().map(|word| word.replace("OUT", text(&out)));
    let mut child = Command::new("bash")
        .args(["-c", &format!("ulimit -t {MOST_SECONDS}; exec \"$0\" \"$@\"")])
        .arg(binary())
        .args(before)
        .arg(package)
        .args(after)
        .stdout(fs::File::create(folder.join("said")).unwrap())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    ended_with_costs(&mut child)
}

/// Runs commands on packages of some families, with a sample of the pairs in each tier; returns the
/// failures.
fn check(families: &[&str], every: [usize; 3], is_asked: impl Fn(&Case, &str) -> bool) {
    let mut broken = Vec::new();
    let (mut pairs, mut chosen) = (0.., some_of(0.., every).peekable());
    for (family, cases) in FAMILIES.iter().filter(|(name, _)| families.contains(name)) {
        for case in cases() {
            for command in COMMANDS.into_iter().filter(|(name, ..)| is_asked(&case, name)) {
                if pairs.next().and_then(|pair: usize| chosen.next_if_eq(&pair)).is_none() {
                    continue;
                }
                let folder = tempfile::tempdir().unwrap();
                let package = folder.path().join("hostile.pmtiles");
                fs::write(&package, &case.bytes).unwrap();
                let (ran, Costs { peak_bytes, cpu_s, .. }) = run(folder.path(), &package, command);
                let said = ran.err.lines().last().unwrap_or_default();
                let line = format!(
                    "{family}: {}: {}: code {}, {cpu_s:.2} s, {} MiB, {said}",
                    case.name,
                    command.0,
                    ran.code,
                    peak_bytes >> 20
                );
                println!("{line}");
                let is_known = matches!(ran.code, 0..=2);
                // A wrong number of tiles in the header is detected only by commands that read the
                // whole list.
                let may_not_see = matches!(case.outcome, ReadOutcome::Refused("fewer or more"));
                let may_not_see = is_read(&case) || may_not_see && command.0 != "verify";
                let is_refused = ran.code != 0 || may_not_see;
                let is_small = peak_bytes >> 20 <= MOST_MIB;
                if !is_known || !is_refused || !is_small || ran.err.contains("panicked") {
                    broken.push(line);
                }
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

fn is_read(case: &Case) -> bool {
    matches!(case.outcome, ReadOutcome::Read)
}

#[test]
fn work_follows_bytes_and_no_coordinate() {
    let commands =
        ["verify", "render sv", "export geotiff", "export geotiff 0", "export quantized-mesh"];
    check(&["lies"], [2, 2, 1], |case, command| is_read(case) && commands.contains(&command));
}

/// Errors are detected when the package is opened, with its first tile, or with the list of all
/// tiles: all commands share this code, so two commands suffice.
#[test]
#[ignore = "slow: every command on every hostile package, some minutes"]
fn every_command_ends_on_every_hostile_package() {
    let families = FAMILIES.map(|(name, _)| name);
    let of_refused = ["verify", "export geotiff"];
    check(&families, [41, 41, 1], |case, command| is_read(case) || of_refused.contains(&command));
}

/// Largest output of a command about a package, except documents, which contain all of it.
const MOST_SAID: u64 = 200_000;

/// Describes how a command fails on a package with a malicious text: it must neither panic nor
/// print endlessly, nor assume a full disk.
fn fault_of_text(
    folder: &Path,
    package: &Path,
    command: (&str, &[&str], &[&str]),
) -> Option<String> {
    let (ran, Costs { peak_bytes, cpu_s, .. }) = run(folder, package, command);
    let said = fs::metadata(folder.join("said")).unwrap().len() + ran.err.len() as u64;
    let is_right = matches!(ran.code, 0..=2)
        && !ran.err.contains("panicked")
        && !ran.err.contains("disk")
        && (said <= MOST_SAID || command.1.contains(&"--json"))
        && peak_bytes >> 20 <= MOST_MIB;
    let last: String = ran.err.chars().take(300).collect();
    let costs = format!("code {}, {cpu_s:.2} s, {} MiB, {said} B", ran.code, peak_bytes >> 20);
    (!is_right).then(|| format!("{}: {costs}: {last}", command.0))
}

/// Each text of the metadata, endless or with special characters, through `info`.
#[test]
fn no_text_of_a_package_makes_info_panic_or_talk_for_ever() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("text.pmtiles");
    let mut faults = Vec::new();
    for case in some_of(text_cases(), [4, 4, 1]) {
        fs::write(&package, &case.bytes).unwrap();
        for command in [("info", &["info"][..], &[][..]), ("json", &["info", "--json"], &[])] {
            let fault = fault_of_text(folder.path(), &package, command);
            faults.extend(fault.map(|fault| format!("{}: {fault}", case.name)));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The same texts through all commands that read a package, and through images with a legend.
#[test]
#[ignore = "slow: every command on every text, some minutes"]
fn no_text_of_a_package_ends_another_command_otherwise() {
    let legend: (&str, &[&str], &[&str]) =
        ("legend", &["render", "-q", "--size", "200x150", "--legend"], &["-o", "OUT.png"]);
    let csv: (&str, &[&str], &[&str]) = (
        "csv",
        &["export", "roads", "-q", "--level", "0", "--crs", "EPSG:4979", "--heights", "as-is"],
        &["-o", "OUT.csv"],
    );
    let commands: Vec<_> = COMMANDS.into_iter().chain([legend, csv]).collect();
    let pairs = text_cases().flat_map(|case| {
        let case = std::rc::Rc::new(case);
        commands.clone().into_iter().map(move |command| (std::rc::Rc::clone(&case), command))
    });
    let mut faults = Vec::new();
    for (case, command) in some_of(pairs, [37, 37, 1]) {
        let folder = tempfile::tempdir().unwrap();
        let package = folder.path().join("text.pmtiles");
        fs::write(&package, &case.bytes).unwrap();
        let fault = fault_of_text(folder.path(), &package, command);
        faults.extend(fault.map(|fault| format!("{}: {fault}", case.name)));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Attribution, datum, CRS, names of inputs, reasons: none of them controls the terminal, nor does
/// a file's name. Programs get them unchanged.
#[test]
fn no_text_of_a_package_commands_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("a\u{1b}[31m\u{202e}b.pmtiles");
    fs::write(&package, commanding_texts()).unwrap();
    let package = text(&package);
    let out = |name: &str| folder.path().join(format!("\u{9b}{name}")).to_str().unwrap().to_owned();
    let [gpkg, tif, mesh, svg] = ["a.gpkg", "a.tif", "a.glb", "a.svg"].map(out);
    let other = folder.path().join("no\u{1b}]0;such\u{7}\ncorniche: forged.pmtiles");
    for words in [
        &["info", package][..],
        &["info", package, "--json"],
        &["growth", package],
        &["growth", package, package, "--csv"],
        &["verify", package],
        &["verify", package, "--json"],
        &["tile", package, "0/0/0"],
        &["export", "roads", package, "-o", &gpkg, "--heights", "as-is"],
        &["export", "geotiff", package, "-o", &tif, "-v", "-v"],
        &["export", "mesh", package, "-o", &mesh, "--log-format", "json"],
        &["growth", package, "--svg", &svg],
        &["info", text(&other)],
        &["info", "--\u{1b}[5mno"],
        &["info", "--no\ncorniche: forged"],
        &["info\ncorniche: forged"],
        &["verify", package, "--max-error", "1\ncorniche: forged"],
        &["render", package, "--size", "1x2\r\n\tcorniche: forged"],
        &["build", "--dem", text(&other), "-o", package],
    ] {
        let ran = corniche(words);
        for said in [&ran.out, &ran.err] {
            let unseen = |one: char| {
                one.is_control() && one != '\n'
                    || ('\u{202a}'..='\u{202e}').contains(&one)
                    || ('\u{2066}'..='\u{2069}').contains(&one)
            };
            assert!(!said.contains(unseen), "{words:?}: {said:?}");
            let is_forged = |line: &str| line.trim_start().starts_with("corniche: forged");
            assert!(!said.lines().any(is_forged), "{words:?}: {said}");
        }
    }
    let told = json(&["info", package, "--json"]);
    assert_eq!(told["manifest"]["attribution"][0], COMMANDING);
}

/// Spans without a road: as many pieces as a few bytes can encode, over a whole tile, are drawn or
/// rejected quickly.
#[test]
fn spans_of_a_million_points_end_soon() {
    let mut broken = Vec::new();
    for number in some_of(0..SPAN_ATTACKS, [37, 9, 1]) {
        let case = span_attack(number);
        let folder = tempfile::tempdir().unwrap();
        let package = folder.path().join("hostile.pmtiles");
        fs::write(&package, &case.bytes).unwrap();
        for roads in ["geo", "sv"] {
            let command =
                ("render", &["render", "-q", "-O", "--roads", roads][..], &["-o", "OUT.png"][..]);
            let (ran, Costs { peak_bytes, cpu_s, .. }) = run(folder.path(), &package, command);
            let line = format!(
                "{number}, {roads}: {} bytes, code {}, {cpu_s:.2} s, {} MiB",
                case.bytes.len(),
                ran.code,
                peak_bytes >> 20
            );
            println!("{line}");
            if !matches!(ran.code, 0..=2) || peak_bytes >> 20 > MOST_MIB {
                broken.push(line);
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}
