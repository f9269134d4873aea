//! The errors of `corniche export`, and the files that remain after a failure.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use e2e::{Ran, copy_pass, corniche, ended, names, sample, send_signal, text, unfinished};
use gdal::{Dataset, vector::LayerAccess as _};

fn pass(folder: &Path) -> PathBuf {
    let package = folder.join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    package
}

fn export(package: &Path, target: &Path, options: &[&str]) -> Ran {
    let mut arguments = vec!["export", "roads", text(package), "-o", text(target)];
    arguments.extend(options);
    corniche(arguments)
}

/// Each error has its exit code, says what to do, and leaves no files.
#[test]
fn what_cannot_be_exported_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    let bare = folder.path().join("bare.pmtiles");
    let dem = sample("pass/pass-dem.tif");
    let ran =
        corniche(["build", "--dem", text(&dem), "-o", text(&bare), "-q", "--max-error", "20"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let before = names(folder.path());
    let at = |name: &str| folder.path().join(name);
    let cases: &[(&Path, &str, &[&str], &str)] = &[
        (&bare, "a.gpkg", &[], "built without --osm"),
        (&package, "a.shp", &[], ".gpkg, .fgb, .geojson, .csv"),
        (&package, "a", &[], "--format"),
        (&package, "a.gpkg", &["--level", "9"], "its finest level is 3"),
        (&package, "a.gpkg", &["--classes", "9"], "0-4,7"),
        (&package, "a.gpkg", &["--classes", "lanes"], "the classes are motorway; trunk; "),
        (&package, "a.gpkg", &["--bounds", "1,2,3"], "west,south,east,north"),
        (&package, "a.gpkg", &["--bounds", "9,48,10,47"], "south must be less"),
        (&package, "a.geojson", &["--crs", "package"], "RFC 7946"),
        (&package, "a.gpkg", &["--crs", "EPSG:4979"], "--heights as-is"),
        (&package, "a.gpkg", &["--crs", "utm"], "ogr2ogr"),
        (&package, "a.gpkg", &["--crs", "EPSG:4258"], "not a projected"),
        (&package, "a.gpkg", &["--crs", "EPSG:1"], "--crs \"EPSG:1\""),
        (&package, "a.gpkg", &["--heights", "as-is"], "--crs EPSG:4979"),
        (&package, "no-folder/a.gpkg", &[], "no-folder"),
        (&package, "pass.pmtiles", &["-O", "--format", "gpkg"], "another name"),
        (&dem, "a.gpkg", &[], "pass-dem.tif"),
    ];
    for (package, target, options, words) in cases {
        let ran = export(package, &at(target), options);
        assert_eq!(ran.code, 2, "{target} {options:?}: {}{}", ran.out, ran.err);
        assert!(ran.err.contains(words), "{target} {options:?}: {}", ran.err);
        assert_eq!(names(folder.path()), before, "{target} {options:?}");
    }
    let ran = corniche(["verify", text(&package), "--quiet"]);
    assert_eq!(ran.code, 0, "the package is what it was: {}", ran.out);
}

/// An existing file is kept unless -O is given; a link stays a link. No other files remain next to
/// it.
#[test]
fn an_existing_file_is_replaced_only_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    let target = folder.path().join("roads.csv");
    fs::write(&target, "mine").unwrap();
    let ran = export(&package, &target, &[]);
    assert_eq!(ran.code, 3, "{}", ran.err);
    assert!(ran.err.contains("-O"), "{}", ran.err);
    assert_eq!(fs::read(&target).unwrap(), b"mine");
    let ran = export(&package, &target, &["-O", "-q"]);
    assert_eq!((ran.code, ran.out.as_str(), ran.err.as_str()), (0, "", ""));
    assert!(fs::read_to_string(&target).unwrap().starts_with("WKT,way_id,class,"));
    assert_eq!(names(folder.path()), ["pass.pmtiles", "roads.csv"]);
    #[cfg(unix)]
    {
        let link = folder.path().join("link.fgb");
        std::os::unix::fs::symlink(&target, &link).unwrap();
        assert_eq!(export(&package, &link, &["-O"]).code, 0);
        assert!(link.symlink_metadata().unwrap().is_symlink());
        assert!(fs::read(&target).unwrap().starts_with(b"fgb"));
    }
}

/// A named format takes precedence over the extension. A selection without roads is an empty layer.
#[test]
fn a_named_format_and_an_empty_selection() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    let target = folder.path().join("roads.dat");
    let ran = export(&package, &target, &["--format", "fgb", "--bounds", "100,10,101,11"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("0 ways"), "{}", ran.err);
    let dataset = Dataset::open(&target).unwrap();
    let layer = dataset.layer(0).unwrap();
    assert_eq!((layer.feature_count(), layer.defn().fields().count()), (0, 26));
    for ending in ["gpkg", "geojson", "csv"] {
        let target = folder.path().join(format!("empty.{ending}"));
        let options = ["--classes", "8", "--crs", "EPSG:4979", "--heights", "as-is"];
        assert_eq!(export(&package, &target, &options).code, 0, "{ending}");
        let dataset = Dataset::open(&target).unwrap();
        assert_eq!(dataset.layer(0).unwrap().feature_count(), 0, "{ending}");
    }
}

fn start(package: &Path, target: &Path) -> Child {
    Command::new(e2e::binary())
        .args(["export", "roads", text(package), "-o", text(target), "--pieces"])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// After Ctrl-C at any moment, the file is either complete or does not exist.
#[test]
#[cfg(unix)]
fn an_interrupted_export_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    let target = folder.path().join("roads.gpkg");
    let mut interrupted = 0;
    for round in 0..12 {
        let mut child = start(&package, &target);
        // From the moment at which the export writes; a little later in every round.
        let begun = Instant::now();
        while unfinished(folder.path()).is_none() && child.try_wait().unwrap().is_none() {
            assert!(begun.elapsed() < Duration::from_mins(1), "it does not begin");
            thread::sleep(Duration::from_millis(1));
        }
        thread::sleep(Duration::from_millis(8 * round));
        let _ = send_signal(&child, "INT");
        let ran = ended(&mut child);
        match ran.code {
            0 => {
                let dataset = Dataset::open(&target).unwrap();
                assert!(dataset.layer(0).unwrap().feature_count() > 67);
                fs::remove_file(&target).unwrap();
            }
            4 => {
                interrupted += 1;
                assert!(ran.err.contains("interrupted"), "{}", ran.err);
            }
            code => panic!("exit code {code}: {}", ran.err),
        }
        assert_eq!(names(folder.path()), ["pass.pmtiles"], "round {round}");
    }
    assert!(interrupted > 0, "every export was faster than the signal");
}

/// Leftovers of a killed export are not the target, and the next export removes them.
#[test]
#[cfg(unix)]
fn what_a_killed_export_leaves_is_removed_by_the_next() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    let target = folder.path().join("roads.gpkg");
    let mut child = start(&package, &target);
    let begun = Instant::now();
    while !unfinished(folder.path()).is_some_and(|made| made.join("roads.gpkg").exists()) {
        assert!(begun.elapsed() < Duration::from_mins(1), "it does not begin");
        assert!(child.try_wait().unwrap().is_none(), "it was faster than the signal");
        thread::sleep(Duration::from_millis(1));
    }
    assert!(send_signal(&child, "KILL"));
    assert_eq!(ended(&mut child).code, -1, "SIGKILL ended it");
    assert!(unfinished(folder.path()).is_some() && !target.exists(), "{:?}", names(folder.path()));
    let ran = export(&package, &target, &[]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_eq!(names(folder.path()), ["pass.pmtiles", "roads.gpkg"]);
}

/// On a full disk, or with a limit on file sizes, wherever the writing fails, every format ends
/// with exit code 1 and leaves nothing. Some libraries do not report that the end of a file is
/// missing.
#[test]
#[cfg(target_os = "linux")]
fn a_file_that_cannot_be_written_to_its_end_is_none() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    for ending in ["gpkg", "fgb", "geojson", "csv"] {
        let target = folder.path().join(format!("roads.{ending}"));
        let wgs84 = ["--crs", "EPSG:4979", "--heights", "as-is"];
        assert_eq!(export(&package, &target, &wgs84).code, 0);
        let whole = fs::metadata(&target).unwrap().len();
        fs::remove_file(&target).unwrap();
        let shares = [40, 70, 95].map(|percent| whole * percent / 100);
        for limit in shares.into_iter().chain([whole - 20_000, whole - 500, whole - 50, whole - 1])
        {
            let mut limited = Command::new("prlimit");
            limited.arg(format!("--fsize={limit}")).arg(e2e::binary());
            limited.args(["export", "roads", text(&package), "-o", text(&target)]).args(wgs84);
            let ran = Ran::from(limited.output().unwrap());
            assert_eq!(ran.code, 1, "{ending}, {limit} of {whole}: {}{}", ran.out, ran.err);
            // The disk has space; the limit is the reason.
            assert!(ran.err.contains("ulimit -f"), "{ending}: {}", ran.err);
            assert!(!ran.err.contains("disk full"), "{ending}: {}", ran.err);
            assert!(ran.err.contains(&format!("roads.{ending}")), "{ending}: {}", ran.err);
            assert_eq!(names(folder.path()), ["pass.pmtiles"], "{ending}");
        }
    }
}
