//! Targets and inputs that are pipes, devices, links or folders: they are never overwritten and
//! never block, and a signal ends a run that hangs.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]
#![cfg(unix)]

use std::{
    fs,
    os::unix::{
        ffi::OsStringExt as _,
        fs::{FileTypeExt as _, symlink},
        net::UnixListener,
    },
    path::{Path, PathBuf},
    process::{Command, Stdio},
    time::{Duration, Instant},
};

use e2e::{Ran, copy_pass, names, run_soon as run, sample, skip, start, text};

/// One path for each kind of entry that is neither a file nor a folder.
fn specials(folder: &Path) -> Vec<PathBuf> {
    let [pipe, socket, device] = ["pipe", "socket", "device"].map(|name| folder.join(name));
    assert!(made("mkfifo", &[text(&pipe)]), "mkfifo makes pipes");
    drop(UnixListener::bind(&socket).unwrap());
    let mut all = vec![pipe, socket];
    // A second /dev/null; only root may create one.
    if made("mknod", &[text(&device), "c", "1", "3"]) {
        all.push(device);
    } else {
        skip("devices, which only root may make");
    }
    all
}

fn made(program: &str, arguments: &[&str]) -> bool {
    let made = Command::new(program).args(arguments).stderr(Stdio::null()).status();
    made.is_ok_and(|status| status.success())
}

fn is_special(path: &Path) -> bool {
    path.symlink_metadata().is_ok_and(|found| {
        let kind = found.file_type();
        kind.is_fifo() || kind.is_socket() || kind.is_char_device()
    })
}

#[test]
fn what_is_no_file_is_never_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let package = text(&package);
    let (dem, osm) = (sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf"));
    let inputs = ["--dem", text(&dem), "--osm", text(&osm)];
    let [free, new_package] = ["free", "free.pmtiles"].map(|name| folder.path().join(name));
    let [free, new_package] = [text(&free), text(&new_package)];
    let specials = specials(folder.path());
    let before = names(folder.path());
    for special in &specials {
        let at = text(special);
        let build = |rest: &[&'static str]| [&["build"], &inputs[..], rest].concat();
        let lines: Vec<Vec<&str>> = vec![
            [&build(&["-O", "-o"])[..], &[at]].concat(),
            [&build(&["-o"])[..], &[at]].concat(),
            [&build(&["-O", "-o"])[..], &[new_package, "--defects", at]].concat(),
            vec!["render", package, "-o", at],
            vec!["growth", package, "--svg", at],
            vec!["export", "roads", package, "-O", "-f", "csv", "-o", at],
            vec!["fly", package, "-O", "-o", at],
            vec!["fly", package, "-o", at],
            vec!["fly", package, "-O", "-o", free, "--svg", at],
            vec!["fly", package, "-O", "-o", free, "--save-path", at],
            vec!["fly", package, "-O", "-o", free, "--png", at],
            vec!["view", package, "--trace", at],
            vec!["view", package, "--folder", at],
        ];
        for line in lines {
            let ran = run(&line);
            assert_eq!(ran.code, 2, "{line:?}: {}", ran.err);
            assert!(ran.err.contains(at), "{line:?}: {}", ran.err);
            assert!(is_special(special), "{line:?} replaced it");
            assert_eq!(names(folder.path()), before, "{line:?} left something behind");
        }
    }
}

#[test]
fn a_pipe_as_input_is_refused_with_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let [package, pipe, free, picture, new_package] =
        ["pass.pmtiles", "pipe", "free", "free.png", "free.pmtiles"]
            .map(|name| folder.path().join(name));
    copy_pass(&package, &["--quiet"]);
    assert!(made("mkfifo", &[text(&pipe)]));
    let (dem, osm) = (sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf"));
    let [package, pipe, free, picture, new_package, dem, osm] =
        [&package, &pipe, &free, &picture, &new_package, &dem, &osm].map(|path| text(path));
    let list = format!("@{pipe}");
    let before = names(folder.path());
    let lines: [&[&str]; 19] = [
        &["build", "--dem", pipe, "-o", new_package],
        &["build", "--dem", &list, "-o", new_package],
        &["verify", package, "--dem", &list],
        &["render", package, "--overlay", pipe, "-o", picture],
        &["build", "--dem", dem, pipe, "-o", new_package],
        &["build", "--dem", dem, "--osm", pipe, "-o", new_package],
        &["build", "--dem", dem, "--config", pipe, "-o", new_package],
        &["build", "--dem", dem, "--osm", osm, "--frc-table", pipe, "-o", new_package],
        &["fly", package, "--path", pipe, "-o", free],
        &["fly", package, "--style", pipe, "-o", free],
        &["render", package, "--style", pipe, "-o", picture],
        &["view", package, "--style", pipe],
        &["verify", package, "--dem", pipe],
        &["verify", pipe],
        &["info", pipe],
        &["growth", pipe],
        &["tile", pipe, "0/0/0"],
        &["render", pipe, "-o", picture],
        &["fly", pipe, "-o", free],
    ];
    for line in lines {
        let ran = run(line);
        assert_eq!(ran.code, 2, "{line:?}: {}", ran.err);
        let tells = ["it", "them"]
            .iter()
            .any(|what| ran.err.contains(&format!("save {what} to a file first")))
            || ran.err.contains("copy it to a regular file");
        assert!(tells && ran.err.contains("pipe"), "{line:?}: {}", ran.err);
        assert_eq!(names(folder.path()), before, "{line:?} left something behind");
    }
}

/// A server accepts the connection and never answers: GDAL waits forever and does not check whether
/// to stop.
#[test]
fn the_first_signal_ends_a_read_that_never_returns() {
    let server = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let dem = format!("/vsicurl/http://{}/dem.tif", server.local_addr().unwrap());
    for signal in ["INT", "TERM"] {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("out.pmtiles");
        let mut child = start(&["build", "--dem", &dem, "-o", text(&target)]);
        server.set_nonblocking(true).unwrap();
        let begun = Instant::now();
        let connection = loop {
            match server.accept() {
                Ok(connection) => break Some(connection),
                Err(_) if child.try_wait().unwrap().is_some() => break None,
                Err(_) => assert!(begun.elapsed() < Duration::from_secs(30), "no connection"),
            }
            std::thread::sleep(Duration::from_millis(10));
        };
        if connection.is_none() {
            skip("this GDAL fetches nothing from servers");
            return;
        }
        assert!(made("kill", &[&format!("-{signal}"), &child.id().to_string()]));
        let sent = Instant::now();
        while child.try_wait().unwrap().is_none() {
            if sent.elapsed() > Duration::from_secs(20) {
                child.kill().unwrap();
                child.wait().unwrap();
                panic!("SIG{signal} does not end it");
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        let ran = e2e::ended(&mut child);
        assert_eq!(ran.code, 4, "SIG{signal}: {}", ran.err);
        assert!(ran.err.contains("interrupted"), "SIG{signal}: {}", ran.err);
        assert_eq!(names(folder.path()), [""; 0], "SIG{signal} left something behind");
    }
}

/// The file that a link points to is overwritten, as by `cp`, and the link stays a link.
#[test]
fn a_link_is_followed_and_stays_a_link() {
    let folder = tempfile::tempdir().unwrap();
    let (elsewhere, here) = (folder.path().join("elsewhere"), folder.path().join("here"));
    fs::create_dir(&elsewhere).unwrap();
    fs::create_dir(&here).unwrap();
    let [file, link] = [elsewhere.join("real.pmtiles"), here.join("link.pmtiles")];
    fs::write(&file, b"precious").unwrap();
    symlink("../elsewhere/real.pmtiles", &link).unwrap();
    let dem = sample("pass/pass-dem.tif");
    let osm = sample("pass/pass.osm.pbf");
    let line = ["build", "--dem", text(&dem), "--osm", text(&osm), "--quiet", "-o", text(&link)];
    let ran = run(&line);
    assert_eq!(ran.code, 3, "{}", ran.err);
    assert_eq!(fs::read(&file).unwrap(), b"precious");
    let ran = run(&[&line[..], &["-O"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(link.symlink_metadata().unwrap().is_symlink(), "the link was replaced");
    assert!(fs::metadata(&file).unwrap().len() > 10_000);

    let [svg, chart] = [elsewhere.join("real.svg"), here.join("chart.svg")];
    fs::write(&svg, b"<svg old").unwrap();
    symlink(&svg, &chart).unwrap();
    let growth = ["growth", text(&file), "--svg", text(&chart)];
    let ran = run(&growth);
    assert_eq!(ran.code, 3, "{}", ran.err);
    assert_eq!(fs::read(&svg).unwrap(), b"<svg old");
    let ran = run(&[&growth[..], &["-O"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(chart.symlink_metadata().unwrap().is_symlink());
    assert!(fs::read_to_string(&svg).unwrap().ends_with("</svg>\n"), "the file is replaced");

    // A link to nothing is rejected as a mistake; a link to a folder or to an input is rejected
    // like its target.
    let [dead, to_folder, to_input] =
        ["dead", "to-folder", "to-input"].map(|name| here.join(format!("{name}.pmtiles")));
    symlink(elsewhere.join("missing"), &dead).unwrap();
    symlink(&elsewhere, &to_folder).unwrap();
    let copy = elsewhere.join("dem.tif");
    fs::copy(&dem, &copy).unwrap();
    symlink(&copy, &to_input).unwrap();
    for target in [&dead, &to_folder, &to_input] {
        let ran = run(&["build", "--dem", text(&copy), "-O", "-o", text(target)]);
        assert_eq!(ran.code, 2, "{}: {}", target.display(), ran.err);
        assert!(target.symlink_metadata().unwrap().is_symlink());
    }
    assert!(!elsewhere.join("missing").exists());
    assert_eq!(fs::read(&copy).unwrap(), fs::read(&dem).unwrap());
}

/// Such a name means a folder. The inputs do not exist, so the message about the target shows that
/// the target is checked first.
#[test]
fn a_target_that_ends_in_a_slash_is_refused_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let target = format!("{}/new.pmtiles/", text(folder.path()));
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let package = text(&package);
    let [free, new_package] = ["free", "free.pmtiles"].map(|name| folder.path().join(name));
    let [free, new_package] = [text(&free), text(&new_package)];
    let osm = sample("pass/pass.osm.pbf");
    let lines: [&[&str]; 6] = [
        &["build", "--dem", "/nowhere.tif", "-o", &target],
        &[
            "build",
            "--dem",
            "/nowhere.tif",
            "--osm",
            text(&osm),
            "-o",
            new_package,
            "--defects",
            &target,
        ],
        &["render", package, "-o", &target],
        &["growth", package, "--svg", &target],
        &["fly", package, "-o", &target],
        &["fly", package, "-o", free, "--svg", &target],
    ];
    for line in lines {
        let ran = run(line);
        assert_eq!(ran.code, 2, "{line:?}: {}", ran.err);
        assert!(
            ran.err.contains("names a folder") && ran.err.contains(&target),
            "{line:?}: {}",
            ran.err
        );
        assert_eq!(names(folder.path()), ["pass.pmtiles"], "{line:?} left something behind");
    }
}

/// GDAL takes names as UTF-8, and a package records names as text.
#[test]
fn a_name_that_is_not_utf_8_is_told_as_such() {
    let folder = tempfile::tempdir().unwrap();
    let name = |bytes: &[u8]| folder.path().join(std::ffi::OsString::from_vec(bytes.to_vec()));
    let [dem, osm] = [name(b"dem-\xff.tif"), name(b"roads-\xfe.osm.pbf")];
    if fs::copy(sample("pass/pass-dem.tif"), &dem).is_err() {
        skip("this file system takes no such names");
        return;
    }
    fs::copy(sample("pass/pass.osm.pbf"), &osm).unwrap();
    let good = sample("pass/pass-dem.tif");
    let package = folder.path().join("out.pmtiles");
    for line in [vec![dem.as_path()], vec![&good, Path::new("--osm"), &osm]] {
        let output = Command::new(e2e::binary())
            .args(["build", "--quiet", "-o", text(&package), "--dem"])
            .args(&line)
            .output()
            .unwrap();
        let ran = Ran::from(output);
        assert_eq!(ran.code, 2, "{line:?}: {}", ran.err);
        assert!(
            ran.err.contains("not UTF-8") && ran.err.contains("rename"),
            "{line:?}: {}",
            ran.err
        );
    }
}

/// `ulimit -f` acts like a full disk: the message names the limit, no file is left, and no signal
/// kills the program.
#[test]
fn a_limit_on_file_sizes_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("out.pmtiles");
    let dem = sample("pass/pass-dem.tif");
    let line = format!(
        "ulimit -f 64; exec '{}' build --dem '{}' -o '{}'",
        text(&e2e::binary()),
        text(&dem),
        text(&target)
    );
    let ran = Ran::from(Command::new("sh").args(["-c", &line]).output().unwrap());
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert!(ran.err.contains("limit on the size of files"), "{}", ran.err);
    assert_eq!(names(folder.path()), [""; 0]);
}
