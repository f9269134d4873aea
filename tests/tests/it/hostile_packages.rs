//! Every command that reads a package made to do harm ends within bounds of computing and memory, and says in one line what is wrong.
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

use corniche_testing::hostile::{COMMANDING, Case, FAMILIES, Outcome, commanding_texts};
use e2e::{Ran, binary, corniche, ended_with_peak, json, text};

/// Seconds of computing that a command may take; the shell ends it then. On a machine of 2026 all stay below ten, those on a software driver
/// included; slower machines get more.
const MOST_SECONDS: u32 = 20;
const MOST_MIB: u64 = 1024;

/// What is done with a package: the words before its name, and those after.
const COMMANDS: [(&str, &[&str], &[&str]); 14] = [
    ("verify", &["verify", "-q"], &[]),
    ("render geo", &["render", "-q", "--size", "200x150", "--roads", "geo"], &["-o", "OUT.png"]),
    ("render sv", &["render", "-q", "--size", "200x150", "--roads", "sv"], &["-o", "OUT.png"]),
    (
        "export roads",
        &["export", "roads", "-q", "--crs", "EPSG:4979", "--heights", "as-is"],
        &["-o", "OUT.gpkg"],
    ),
    // As people call it: what it refuses without a system for its heights, it refuses soon.
    ("export roads plain", &["export", "roads", "-q"], &["-o", "OUT.gpkg"]),
    ("export areas", &["export", "areas", "-q"], &["-o", "OUT.gpkg"]),
    ("export boundaries", &["export", "boundaries", "-q"], &["-o", "OUT.gpkg"]),
    ("export mesh", &["export", "mesh", "-q"], &["-o", "OUT.glb"]),
    ("export tiles3d", &["export", "3dtiles", "-q", "--heights", "as-is"], &["-o", "OUT.tiles"]),
    (
        "export quantized-mesh",
        &["export", "quantized-mesh", "-q", "--heights", "as-is"],
        &["-o", "OUT.terrain"],
    ),
    ("export geotiff", &["export", "geotiff", "-q"], &["-o", "OUT.tif"]),
    ("info", &["info"], &[]),
    ("growth", &["growth"], &[]),
    ("tile", &["tile", "--json"], &["0/0/0"]),
];

/// Runs a command within the limit of time, and tells its memory.
fn run(folder: &Path, package: &Path, (_, before, after): (&str, &[&str], &[&str])) -> (Ran, u64) {
    let out = folder.join("out");
    let after = after.iter().map(|word| word.replace("OUT", text(&out)));
    let mut child = Command::new("bash")
        .args(["-c", &format!("ulimit -t {MOST_SECONDS}; exec \"$0\" \"$@\"")])
        .arg(binary())
        .args(before)
        .arg(package)
        .args(after)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    ended_with_peak(&mut child)
}

/// Tries commands on packages of some families; tells what is not as it should be.
fn check(families: &[&str], commands: &[&str], is_asked: impl Fn(&Case) -> bool) {
    let mut broken = Vec::new();
    for (family, cases) in FAMILIES.iter().filter(|(name, _)| families.contains(name)) {
        for case in cases().into_iter().filter(|case| is_asked(case)) {
            for command in COMMANDS.into_iter().filter(|(name, ..)| commands.contains(name)) {
                let folder = tempfile::tempdir().unwrap();
                let package = folder.path().join("hostile.pmtiles");
                fs::write(&package, &case.bytes).unwrap();
                let (ran, peak) = run(folder.path(), &package, command);
                let said = ran.err.lines().last().unwrap_or_default();
                let line = format!(
                    "{family}: {}: {}: code {}, {} MiB, {said}",
                    case.name,
                    command.0,
                    ran.code,
                    peak >> 20
                );
                println!("{line}");
                let is_known = matches!(ran.code, 0..=2);
                let is_refused = ran.code != 0 || matches!(case.outcome, Outcome::Read);
                if !is_known || !is_refused || peak >> 20 > MOST_MIB || ran.err.contains("panicked")
                {
                    broken.push(line);
                }
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn work_follows_bytes_and_no_coordinate() {
    let is_read = |case: &Case| matches!(case.outcome, Outcome::Read);
    check(&["lies"], &["verify", "render sv", "export geotiff"], is_read);
}

#[test]
#[ignore = "slow: every command on every hostile package, some minutes"]
fn every_command_ends_on_every_hostile_package() {
    let commands: Vec<&str> = COMMANDS.iter().map(|(name, ..)| *name).collect();
    let families: Vec<&str> = FAMILIES.iter().map(|(name, _)| *name).collect();
    let is_read = |case: &Case| matches!(case.outcome, Outcome::Read);
    check(&families, &commands, is_read);
    // What is refused is refused when it is opened, or with its first tile: by one way for all commands.
    check(&families, &["verify", "export geotiff"], |case| !is_read(case));
}

/// Attribution, datum, CRS, names of inputs, reasons: nothing of it commands the terminal, nor does a file's name. Programs get it as it is.
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
