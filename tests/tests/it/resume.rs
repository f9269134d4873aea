//! Leftovers of builds that ended early: when they are named, kept, resumed, rejected and removed.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]
#![cfg(unix)]

use std::{
    fs,
    path::{Path, PathBuf},
    time::Duration,
};

use e2e::{Job, Ran, When, sample, text};

/// The build takes so long that it can be stopped in the middle.
const OPTIONS: [&str; 4] = ["--max-error", "0.25", "--threads", "2"];

/// A build that was requested to end when it had durable work.
fn stopped(job: Job) -> Job {
    let ran = job.stop(&[], "TERM", When::Worked);
    assert_eq!(ran.code, 4, "{}", ran.err);
    assert!(job.has_work() && job.names() == [".out.pmtiles.work"], "{:?}", job.names());
    job
}

/// It is rejected with this code and these words, and the store is unchanged.
fn check_refused(job: &Job, more: &[&str], code: i32, words: &[&str]) {
    let before = job.stored();
    let ran = job.run(&[&["--quiet"], more].concat());
    assert_eq!(ran.code, code, "{more:?}: {}", ran.err);
    for word in words {
        assert!(ran.err.contains(word), "{more:?}: no {word:?} in: {}", ran.err);
    }
    assert!(job.stored() == before, "{more:?}: the store was touched");
    assert!(!job.package().exists());
}

fn whole() -> [Vec<u8>; 2] {
    let job = Job::new(&OPTIONS);
    job.succeed(&["--quiet"]);
    job.result()
}

#[test]
fn leftovers_are_named_and_nothing_is_touched_until_one_says_what_to_do() {
    let job = stopped(Job::new(&OPTIONS));
    check_refused(&job, &[], 1, &[".out.pmtiles.work", "--resume", "-O"]);
    // After discarding, it starts again, and no stage is reported as done already.
    let ran = job.said(&["-O", "--json-progress"]);
    assert!(!ran.err.contains("--resume"), "{}", ran.err);
    let begun = ran.err.lines().filter(|line| line.contains("\"already\":"));
    assert!(begun.clone().count() > 5 && begun.clone().all(|line| line.contains("\"already\":0")));
    assert!(job.result() == whole());
}

#[test]
fn a_store_of_other_settings_is_refused_by_name() {
    let job = stopped(Job::new(&OPTIONS));
    let other = ["--resume", "--fill-voids", "7"];
    check_refused(&job, &other, 1, &[".out.pmtiles.work", "--fill-voids", "7"]);
    let other = ["--resume", "--attribution", "somebody"];
    check_refused(&job, &other, 1, &["--attribution", "somebody"]);
    // Resources of a run are not settings of the package.
    job.succeed(&["--resume", "--memory", "300M", "--quiet"]);
    assert!(job.result() == whole());
}

#[test]
fn a_store_of_inputs_that_changed_since_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let inputs = ["pass-dem.tif", "pass.osm.pbf"].map(|name| {
        let copy = folder.path().join(name);
        fs::copy(sample("pass").join(name), &copy).unwrap();
        copy
    });
    let job = stopped(Job::new(&OPTIONS).with_inputs(inputs.clone()));
    // Another modification time suffices.
    let file = fs::File::options().append(true).open(&inputs[1]).unwrap();
    let time = file.metadata().unwrap().modified().unwrap();
    file.set_modified(time + Duration::from_secs(1)).unwrap();
    check_refused(&job, &["--resume"], 1, &["pass.osm.pbf", "has changed"]);
    file.set_modified(time).unwrap();
    job.succeed(&["--resume", "--quiet"]);
    assert!(job.result() == whole());
}

#[test]
fn with_nothing_to_go_on_from_a_build_starts() {
    let job = Job::new(&["--quiet"]);
    let ran = job.said(&["--resume"]);
    assert!(ran.err.contains("contains nothing to resume"), "{}", ran.err);
    let first = job.result();
    // An existing package is overwritten only on request.
    let ran = job.run(&["--resume"]);
    assert_eq!(ran.code, 3, "{}", ran.err);
    job.succeed(&["--resume", "-O"]);
    assert!(job.result() == first);
}

#[test]
fn of_two_builds_of_one_target_one_is_refused() {
    let job = Job::new(&OPTIONS);
    let mut first = job.start(&["--quiet"]);
    // It is at work when its store exists.
    while !job.store().join("store").exists() {
        assert!(first.try_wait().unwrap().is_none(), "the build ended before it was at work");
        std::thread::sleep(Duration::from_millis(2));
    }
    // The second has no list of defects, because a locked list would be rejected, too.
    let second = |more: &[&str]| -> Ran {
        let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
        let package = job.package();
        let line = ["build", "--dem", text(&dem), "--osm", text(&osm), "-o", text(&package)];
        e2e::corniche(line.iter().chain(&OPTIONS).chain(more))
    };
    for more in [&["--quiet"][..], &["--quiet", "--resume"], &["--quiet", "-O"]] {
        let ran = second(more);
        assert_eq!(ran.code, 1, "{more:?}: {}", ran.err);
        assert!(ran.err.contains("is being built by another process"), "{}", ran.err);
        assert!(first.try_wait().unwrap().is_none(), "the first build ended: nothing was tested");
    }
    assert_eq!(e2e::ended(&mut first).code, 0);
    assert!(job.result() == whole());
}

#[test]
fn the_store_lies_where_tmp_says() {
    let elsewhere = tempfile::tempdir().unwrap();
    let job = Job::new(&[&OPTIONS[..], &["--tmp", text(elsewhere.path())]].concat());
    let mut child = job.start(&["--quiet"]);
    // Its name begins with the package's and has a part that is derived from the package's folder.
    let stores = || -> Vec<PathBuf> {
        let entries = fs::read_dir(elsewhere.path()).unwrap();
        entries.map(|entry| entry.unwrap().path()).collect()
    };
    let has_work = || {
        let store = stores().pop();
        store.is_some_and(|store| fs::read_dir(store).is_ok_and(|files| files.count() > 2))
    };
    while !has_work() {
        assert!(child.try_wait().unwrap().is_none(), "the build ended before it was at work");
    }
    std::thread::sleep(Duration::from_millis(300));
    child.kill().unwrap();
    child.wait().unwrap();
    let store = stores().pop().unwrap();
    let name = store.file_name().unwrap().to_string_lossy().into_owned();
    assert!(
        name.starts_with("out.pmtiles.") && store.extension().is_some_and(|end| end == "work"),
        "{name}"
    );
    assert!(!job.store().exists() && stores().len() == 1);
    let ran = job.run(&["--quiet"]);
    assert!(ran.code == 1 && ran.err.contains(text(&store)), "{}", ran.err);
    job.succeed(&["--quiet", "--resume"]);
    assert!(job.result() == whole());
    assert_eq!(fs::read_dir(elsewhere.path()).unwrap().count(), 0);
}

/// Sets the version in the header of a store, and its checksum.
fn set_version(store: &Path, version: u32) {
    let path = store.join("store");
    let mut bytes = fs::read(&path).unwrap();
    bytes[8..12].copy_from_slice(&version.to_le_bytes());
    let crc = crc32fast::hash(&bytes[..44]);
    bytes[44..48].copy_from_slice(&crc.to_le_bytes());
    fs::write(&path, bytes).unwrap();
}

#[test]
fn a_store_of_another_version_is_kept_and_refused() {
    let job = stopped(Job::new(&OPTIONS));
    set_version(&job.store(), 99);
    check_refused(&job, &["--resume"], 2, &["another version", "99"]);
    check_refused(&job, &[], 2, &[".out.pmtiles.work"]);
    set_version(&job.store(), 1);
    job.succeed(&["--quiet", "--resume"]);
    assert!(job.result() == whole());
}

/// If a store is removed while the build runs, this is an error, and no package without its tiles
/// is written.
#[test]
fn a_store_that_is_removed_under_a_build_is_an_error() {
    let job = Job::new(&OPTIONS);
    let mut child = job.start(&["--quiet"]);
    while !job.has_work() {
        assert!(child.try_wait().unwrap().is_none(), "the build ended before it had work");
    }
    let aside = job.folder().join("aside");
    fs::rename(job.store(), &aside).unwrap();
    let ran = e2e::ended(&mut child);
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert!(ran.err.contains(".out.pmtiles.work") && ran.err.contains("deleted"), "{}", ran.err);
    assert!(!job.package().exists());
    // After it is moved back, the build resumes.
    let _ = fs::remove_dir_all(job.store());
    fs::rename(&aside, job.store()).unwrap();
    job.succeed(&["--quiet", "--resume"]);
    assert!(job.result() == whole());
}

/// A folder with other contents is never emptied, not even with `-O`.
#[test]
fn what_is_not_corniches_is_never_removed() {
    let job = Job::new(&["--quiet"]);
    fs::create_dir(job.store()).unwrap();
    fs::write(job.store().join("precious.txt"), "mine").unwrap();
    for more in [&[][..], &["-O"], &["--resume"]] {
        let ran = job.run(more);
        assert_eq!(ran.code, 1, "{more:?}: {}", ran.err);
        assert!(ran.err.contains(".out.pmtiles.work"), "{more:?}: {}", ran.err);
        assert_eq!(fs::read(job.store().join("precious.txt")).unwrap(), b"mine");
        assert!(!job.package().exists());
    }
}
