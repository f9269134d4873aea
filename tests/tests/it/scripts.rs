//! Messages of the scripts on machines that cannot build, the layout of an archive, and the
//! measurements of a GPU.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, os::unix::fs::PermissionsExt, path::Path, process::Command};

/// Runs `scripts/demo` with only the system's tools and these stand-ins on the path.
fn demo(stand_ins: &[(&str, &str)]) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().unwrap();
    // The tools that the script needs before it builds, without the machine's own cargo.
    for tool in ["bash", "env", "dirname", "sed", "awk", "uname", "grep"] {
        let found = ["/bin", "/usr/bin"]
            .map(|path| Path::new(path).join(tool))
            .into_iter()
            .find(|path| path.exists());
        std::os::unix::fs::symlink(found.unwrap(), folder.path().join(tool)).unwrap();
    }
    for (name, text) in stand_ins {
        let path = folder.path().join(name);
        fs::write(&path, format!("#!/bin/sh\n{text}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }
    let mut demo = Command::new(e2e::root().join("scripts/demo"));
    // An existing target folder would suggest that there is enough space.
    demo.env("PATH", folder.path()).env("CARGO_TARGET_DIR", folder.path().join("target"));
    // A driver, whether this machine has one or not.
    fs::write(folder.path().join("driver.json"), "{}").unwrap();
    demo.env("VULKAN_DRIVERS", folder.path());
    let done = demo.output().unwrap();
    (done.status.code(), String::from_utf8(done.stderr).unwrap())
}

#[test]
fn without_cargo_the_way_to_it_is_told() {
    let (code, said) = demo(&[]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("cargo is missing") && said.contains("https://rustup.rs"), "{said}");
}

/// Debian 12 has cargo 0.66, which does not know the edition of the manifests.
#[test]
fn an_old_cargo_is_named_with_the_way_to_a_newer_one() {
    let (code, said) = demo(&[("cargo", "echo cargo 1.63.0")]);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("cargo 1.63.0, 1.95 is needed") && said.contains("https://rustup.rs"),
        "{said}"
    );
    let (code, said) = demo(&[("cargo", "echo cargo 1.94.1"), ("rustup", "exit 1")]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("rustup update stable"), "{said}");
}

/// The disk space is checked before anything is compiled.
#[test]
fn too_little_disk_space_is_said_first() {
    let libraries = "echo libvulkan.so.1 libX11-xcb.so.1 libXcursor.so.1 libXi.so.6 libXrandr.so.2 libxkbcommon-x11.so.0";
    let (code, said) = demo(&[
        ("cargo", "[ \"$1\" = --version ] && echo cargo 99.0.0 || { echo compiled >&2; exit 1; }"),
        ("df", "echo header; echo disk 100 50 1048576 50% /"),
        ("cc", "exit 0"),
        ("c++", "exit 0"),
        ("pkg-config", "exit 0"),
        ("ldconfig", libraries),
    ]);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("GB of disk space, 1 GB are free") && !said.contains("compiled"),
        "{said}"
    );
}

/// The last lines of `scripts/test`, for a run with a failed test, a skipped one and an omitted
/// slow one.
#[test]
fn tests_are_counted_with_those_that_are_skipped() {
    let folder = tempfile::tempdir().unwrap();
    let (output, skipped) = (folder.path().join("output"), folder.path().join("skipped"));
    let result = |passed, failed, ignored| {
        format!("test result: ok. {passed} passed; {failed} failed; {ignored} ignored; 0 measured")
    };
    let lines = [
        "test rooms::cellar::a_lamp_burns ... FAILED".to_owned(),
        result(7, 1, 2),
        result(3, 0, 0),
    ];
    fs::write(&output, lines.join("\n")).unwrap();
    // One test reports twice that a part of it is skipped, for two reasons.
    let said_of = |test: &str, reason: &str| format!("it rooms::{test}: {reason}\n");
    let ladder = said_of("attic", "no ladder: none in ../shared").repeat(2);
    let need = "need elevation files that are not in the repository";
    let files = said_of("attic", need) + &said_of("cellar", need);
    fs::write(&skipped, ladder + &files + &said_of("cellar", "need light")).unwrap();
    let count = |tier: &str| {
        let script =
            ". scripts/lib/setup.sh; . scripts/lib/count-tests.sh; count_tests \"$@\" 2>&1";
        let mut bash = Command::new("bash");
        bash.args(["-c", script, "bash"]).arg(&output).arg(&skipped).arg(tier);
        let done = bash.current_dir(e2e::root()).output().unwrap();
        assert!(done.status.success());
        String::from_utf8(done.stdout).unwrap()
    };
    let said = count("quick");
    assert!(said.ends_with("8 passed, 1 failed, 4 skipped\n"), "{said}");
    assert!(said.contains("failed:\n  rooms::cellar::a_lamp_burns\n"), "{said}");
    let reasons = format!(
        "and why:\n  2 tests {need}\n  1 test: no ladder: none in ../shared\n  1 test needs light\n"
    );
    assert!(said.contains(&reasons), "{said}");
    assert!(said.contains("2 slow tests"), "{said}");
    let said = count("full");
    assert!(said.ends_with("8 passed, 1 failed, 2 skipped\n"), "{said}");
    fs::write(&output, "error: could not compile").unwrap();
    assert!(count("quick").contains("they do not compile"));
}

/// The layout that the archive, the wheel and the image share, around the program at hand.
#[test]
fn an_archive_is_laid_out_around_a_program() {
    let folder = tempfile::tempdir().unwrap();
    let done = Command::new(e2e::root().join("scripts/release"))
        .args(["--folder", "--program", e2e::text(&e2e::binary())])
        .args(["--out", e2e::text(folder.path())])
        .env("CARGO_TARGET_DIR", folder.path().join("target"))
        .output()
        .unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let made = folder.path().join(concat!("corniche-", env!("CARGO_PKG_VERSION"), "-x86_64-linux"));
    for name in [
        "bin/corniche",
        "README.md",
        "share/man/man1/corniche.1",
        "share/man/man1/corniche-build.1",
        "share/bash-completion/completions/corniche",
        "share/zsh/site-functions/_corniche",
        "share/fish/vendor_completions.d/corniche.fish",
        "share/corniche/licences/LICENSE-MIT",
    ] {
        assert!(made.join(name).metadata().unwrap().len() > 0, "{name} is missing");
    }
    let readme = fs::read_to_string(made.join("README.md")).unwrap();
    assert!(readme.starts_with("# Corniche 0."), "{readme}");
}

/// One command measures the costs of a GPU, reports omitted measurements, and does not treat a
/// software renderer as a GPU.
#[test]
fn what_needs_a_card_is_measured_in_one_command() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    e2e::copy_pass(&package, &["--quiet"]);
    let png = folder.path().join("probe.png");
    let Some(probe) = e2e::draw("render", &package, &png, &["--size", "32x32"]) else { return };
    let python = std::env::var("CORNICHE_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let out = folder.path().join("card");
    let measure = |options: &[&str]| {
        let mut command = Command::new(&python);
        command.arg(e2e::root().join("scripts/card")).arg("--out").arg(&out).args(options);
        let done = command.env("CORNICHE", e2e::binary()).output().unwrap();
        (done.status.code(), String::from_utf8(done.stderr).unwrap())
    };
    let small = ["--size", "48x32", "--frames", "3", "--rounds", "1", e2e::text(&package)];
    let (code, said) = measure(&[&["--parts", "curves,layers"][..], &small].concat());
    assert_eq!(code, Some(0), "{said}");
    let told: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("card.json")).unwrap()).unwrap();
    let page = fs::read_to_string(out.join("card.md")).unwrap();
    let adapter = told["adapter"].as_str().unwrap();
    assert!(probe.err.contains(adapter) && page.starts_with(&format!("# Measured on {adapter}\n")));
    let is_software = adapter.contains("llvmpipe") || adapter.contains("SwiftShader");
    assert_eq!(told["software"], is_software, "{adapter}");
    assert_eq!(page.contains("not by a GPU"), is_software);
    let pass = &told["curves"]["pass"];
    let curves: Vec<&String> = pass["flights"].as_object().unwrap().keys().collect();
    let methods = ["none", "geo-no-caps", "geo", "sv-no-caps", "sv"];
    assert_eq!(curves.len(), methods.len(), "{curves:?}");
    for method in methods {
        let flight = &pass["flights"][format!("lod {method}")];
        let frame_ms = flight["draw_ms"]["mean"].as_f64().unwrap();
        let frames_per_s = flight["frames_per_s"].as_f64().unwrap();
        assert!((frames_per_s * frame_ms - 1000.0).abs() < 1e-6, "{flight}");
        assert_eq!(flight["frames"], 2, "the first frame is left out");
        let roads = &flight["bytes_of_roads_most"];
        assert_eq!(roads.as_f64().is_some_and(|bytes| bytes > 0.0), method != "none", "{flight}");
    }
    // The table of each flight has the loss, too.
    let list = fs::read_to_string(out.join("curves-pass-1.csv")).unwrap();
    let rows: Vec<Vec<&str>> = list.lines().map(|line| line.split(',').collect()).collect();
    let at = |name: &str| rows[0].iter().position(|heading| *heading == name).unwrap();
    let [roads, frame, draw] = ["roads", "frame", "draw_ms"].map(at);
    let drawn_ms = |method: &str| -> f64 {
        let of = rows.iter().filter(|row| row[roads] == method && row[frame] != "0");
        of.map(|row| row[draw].parse::<f64>().unwrap()).sum()
    };
    let loss = 100.0 * (1.0 - drawn_ms("none") / drawn_ms("sv"));
    let found = pass["flights"]["lod sv"]["loss_pct_by_draw"]["in_all"].as_f64().unwrap();
    assert!((loss - found).abs() < 1e-6, "{loss} {found}");
    // A column for each of the five.
    for beside in [
        "average |  |  | 26 | 35 | 42 |",
        "most |  |  | 30 | 40 | 55 |",
        "goal pct |  |  | 10 |  | 20 |",
    ] {
        assert!(page.contains(beside), "{beside}: {page}");
    }
    for left_out in ["levels", "pixels", "excluded by --parts", "layers: pass has none"] {
        assert!(said.contains(left_out) && page.contains(left_out), "{left_out}: {said}");
    }
    // The existing folder is unchanged.
    let (code, said) = measure(&small);
    assert!(code == Some(1) && said.contains("is not empty"), "{said}");
}
