//! The disk of a build's store fails at any time and in any way: there is a clear error and no
//! package, and `--resume` completes it with the same bytes.
//!
//! Source: the tests of `SQLite` that let the n-th call fail for n = 1, 2, 3 … until none fails,
//! and that lose unsynced writes at a simulated crash.

#![allow(clippy::unwrap_used, reason = "helpers of tests may unwrap")]

use std::{
    error::Error,
    fs,
    path::{Path, PathBuf},
    time::Duration,
};

use crate::support::{Options, Raster, extract, settings};
use corniche_pipeline::{BuildError, build_on};
use corniche_spec::{BuildSettings, Leftovers};
use corniche_testing::{
    Random,
    disks::{DiskFailure, MemoryDisk},
    some_of,
};
use corniche_tileset::FilePackage;
use corniche_work::Silent;
use tempfile::TempDir;

/// Every artifact is synced at once.
const ALWAYS: Duration = Duration::ZERO;
/// Artifacts are synced when the build ends.
const NEVER: Duration = Duration::MAX;

/// The folder of the stores, on disks in memory.
const STORES: &str = "/stores";

/// A small build of five tiles with roads. The package is on a real disk, the store on one in
/// memory.
struct Small {
    folder: TempDir,
    settings: BuildSettings,
    /// The package of an uninterrupted build.
    whole: Vec<u8>,
}

impl Small {
    fn new(threads: usize) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let [dem, osm, output] =
            ["dem.tif", "roads.osm.pbf", "out.pmtiles"].map(|name| folder.path().join(name));
        // The raster is around a corner of four tiles.
        let raster = Raster::new([24, 20], [-11, -9], |i, j| {
            500.0 + (i * 7 % 13) as f32 + (j * 5 % 11) as f32
        });
        raster.write(&dem);
        let road = |from, to| extract::StraightRoad { from, to };
        let roads = [road([1.5, 2.0], [21.0, 17.5]), road([3.0, 16.0], [20.0, 1.5])];
        extract::write(&osm, &raster, &roads);
        let options = Options { threads, ..Options::plain(0.5) };
        let settings = BuildSettings {
            tmp: Some(STORES.into()),
            // A disk in memory has no free space to query.
            force: true,
            leftovers: Leftovers::Resume,
            ..settings(dem, Some(osm), output, options)
        };
        let mut small = Self { folder, settings, whole: Vec::new() };
        small.whole = small.taken_package(&empty_disk(), NEVER).unwrap();
        small
    }

    fn output(&self) -> &Path {
        &self.settings.output
    }

    fn build(&self, disk: &MemoryDisk, interval: Duration) -> Result<(), BuildError> {
        build_on(&disk.disk(), interval, &self.settings, &Silent).map(drop)
    }

    /// Builds, and removes the package after reading it.
    fn taken_package(&self, disk: &MemoryDisk, interval: Duration) -> Result<Vec<u8>, BuildError> {
        self.build(disk, interval)?;
        let bytes = fs::read(self.output()).unwrap();
        fs::remove_file(self.output()).unwrap();
        Ok(bytes)
    }

    /// Asserts that there is neither a package nor an unfinished file next to its path.
    fn check_no_package(&self) {
        assert_eq!(self.names(), ["dem.tif", "roads.osm.pbf"]);
    }

    fn names(&self) -> Vec<String> {
        let names = fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> =
            names.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Asserts that the build completes now, with the bytes of an uninterrupted one, and leaves no
    /// store.
    fn check_goes_on(&self, disk: &MemoryDisk, what: &str) {
        let bytes = self.taken_package(disk, NEVER).unwrap_or_else(|error| {
            panic!("{what}: {}", told(&error));
        });
        assert!(bytes == self.whole, "{what}: different bytes after resuming");
        self.check_no_package();
        assert_eq!(disk.paths(), Vec::<PathBuf>::new(), "{what}");
    }

    /// Lets each call fail in turn until none fails (in full mode; otherwise only some calls).
    /// `check` receives the result; then the build must resume. Returns about how many calls there
    /// were.
    fn every_call(
        &self,
        failure: DiskFailure,
        interval: Duration,
        check: impl Fn(&MemoryDisk, Result<(), BuildError>, &str) -> MemoryDisk,
    ) -> u64 {
        for call in some_of(0.., [41, 11, 1]) {
            let disk = empty_disk();
            disk.fail_after(call, failure);
            let result = self.build(&disk, interval);
            let what = format!("{failure:?} at call {call}");
            if disk.is_failure_to_come() {
                result.unwrap();
                fs::remove_file(self.output()).unwrap();
                return call;
            }
            if result.is_ok() {
                // Only the deletion of the store may fail without an error, because the package is
                // complete.
                assert!(fs::read(self.output()).unwrap() == self.whole, "{what}");
                fs::remove_file(self.output()).unwrap();
            }
            self.check_no_package();
            let disk = check(&disk, result, &what);
            self.check_goes_on(&disk, &what);
        }
        unreachable!("the loop ends when nothing fails");
    }
}

fn empty_disk() -> MemoryDisk {
    MemoryDisk::with_folder(Path::new(STORES))
}

/// The text of an error and its causes.
fn told(error: &dyn Error) -> String {
    let causes = std::iter::successors(error.source(), |&error| error.source());
    causes.fold(error.to_string(), |said, cause| format!("{said}: {cause}"))
}

/// Asserts that the error blames the disk, not the inputs, and names the store.
fn check_error(error: &BuildError, what: &str) -> String {
    let said = told(error);
    assert!(!error.is_unusable_input(), "{what}: {said}");
    assert!(said.contains(STORES) || said.contains("disk"), "{what}: {said}");
    said
}

#[test]
fn the_build_has_five_tiles_and_the_same_bytes_on_any_disk() {
    let small = Small::new(1);
    fs::write(small.output(), &small.whole).unwrap();
    assert_eq!(FilePackage::open(small.output()).unwrap().tile_ids().unwrap().len(), 5);
    fs::remove_file(small.output()).unwrap();
    for interval in [ALWAYS, NEVER] {
        assert!(small.taken_package(&empty_disk(), interval).unwrap() == small.whole);
    }
    assert!(Small::new(2).whole == small.whole, "two threads give different bytes");
}

fn a_device_that_fails_at_any_call(threads: usize) {
    let small = Small::new(threads);
    let calls = small.every_call(DiskFailure::Device, ALWAYS, |disk, result, what| {
        if let Err(error) = result {
            check_error(&error, what);
        }
        disk.clone()
    });
    assert!(calls > 100, "only {calls} calls");
}

#[test]
fn a_device_that_fails_at_any_call_is_an_error_and_the_build_goes_on_with_one_thread() {
    a_device_that_fails_at_any_call(1);
}

#[test]
fn a_device_that_fails_at_any_call_is_an_error_and_the_build_goes_on_with_two_threads() {
    a_device_that_fails_at_any_call(2);
}

#[test]
fn a_disk_that_is_full_at_any_call_says_so_and_the_build_goes_on_when_there_is_room() {
    for threads in [1, 2] {
        let small = Small::new(threads);
        let calls = small.every_call(DiskFailure::Full, NEVER, |disk, result, what| {
            if let Err(error) = result {
                let said = check_error(&error, what);
                assert!(said.contains("the disk is full"), "{what}: {said}");
                assert!(said.contains("--tmp"), "{what}: {said}");
                // While the disk is full, resuming fails in the same way.
                check_error(&small.build(disk, NEVER).unwrap_err(), what);
                small.check_no_package();
            }
            disk.make_room();
            disk.clone()
        });
        assert!(calls > 50, "only {calls} calls");
    }
}

#[test]
fn an_interrupted_or_short_call_is_survived_without_a_trace() {
    for (failure, threads) in [(DiskFailure::Interrupted, 1), (DiskFailure::Short, 2)] {
        let small = Small::new(threads);
        small.every_call(failure, NEVER, |disk, result, what| {
            result.unwrap_or_else(|error| panic!("{what}: {}", told(&error)));
            disk.clone()
        });
    }
}

/// A failure like SIGKILL: the machine keeps running.
#[test]
fn a_process_that_dies_at_any_call_can_be_gone_on_from() {
    let small = Small::new(1);
    small.every_call(DiskFailure::Death, NEVER, |disk, _, _| disk.after_kill());
}

/// A failure like a power loss at any time: some of the unsynced data are lost, some are torn.
/// Several crashes follow each other.
#[test]
fn a_crash_at_any_time_loses_work_but_never_changes_a_byte() {
    let small = [Small::new(1), Small::new(2)];
    let [calls, calls_to_sync] = [NEVER, ALWAYS].map(|interval| {
        let disk = empty_disk();
        small[0].taken_package(&disk, interval).unwrap();
        disk.calls()
    });
    let mut went_on = 0;
    for seed in 0..30 {
        let mut random = Random::new(seed);
        let small = &small[seed as usize % 2];
        let (interval, calls) =
            if random.below(3) == 0 { (NEVER, calls) } else { (ALWAYS, calls_to_sync) };
        let mut disk = empty_disk();
        for crash in 0..3 {
            disk.fail_after(random.below(calls as i64) as u64, DiskFailure::Death);
            if small.build(&disk, interval).is_ok() {
                let what = format!("seed {seed}, crash {crash}");
                assert!(fs::read(small.output()).unwrap() == small.whole, "{what}");
                fs::remove_file(small.output()).unwrap();
            }
            small.check_no_package();
            // Nothing more reaches the disk, not even what is written at the end.
            disk.fail_after(0, DiskFailure::Death);
            disk = disk.after_crash(&mut random);
            went_on +=
                u32::from(disk.paths().iter().any(|path| is_journal_with_entries(&disk, path)));
        }
        small.check_goes_on(&disk, &format!("seed {seed}"));
    }
    assert!(went_on > 30, "only {went_on} of 90 crashes left any work: the test checks too little");
}

/// Whether a file lists artifacts: such a file is a journal that is longer than its header of 48
/// bytes.
fn is_journal_with_entries(disk: &MemoryDisk, path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "journal")
        && disk.content(path).is_some_and(|bytes| bytes.len() > 48)
}
