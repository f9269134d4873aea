//! A build in parts on object storage, with inputs, stores and package there: the bytes of an
//! ordinary build, even if parts are killed.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]
#![cfg(unix)]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use e2e::{
    ObjectStorage, Ran, STORE_HEADER_BYTES, corniche, ended, sample, send_signal, text, went_on,
};
use tempfile::TempDir;

const STORE: &str = "s3://maps/alps/build";
/// The time after which artifacts are durable: a little more than `SYNC_INTERVAL` of the store.
const LONGER_THAN_A_SYNC: Duration = Duration::from_millis(2_500);
/// With these options, tiles take about a second.
const FINE: [&str; 2] = ["--max-error", "0.02"];
const COARSE: [&str; 2] = ["--max-error", "10"];

/// A plan from inputs on object storage, and the result of an ordinary build from the same files.
struct Planned {
    storage: ObjectStorage,
    folder: TempDir,
    plan: PathBuf,
    tmp: PathBuf,
    options: [&'static str; 2],
    whole: Vec<u8>,
}

impl Planned {
    /// Returns `None` if there is no object storage server.
    fn new(options: [&'static str; 2]) -> Option<Self> {
        let storage = ObjectStorage::start()?;
        let folder = tempfile::tempdir().unwrap();
        let [plan, package, tmp] =
            ["plan.json", "whole.pmtiles", "tmp"].map(|name| folder.path().join(name));
        fs::create_dir(&tmp).unwrap();
        let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
        storage.put("in/pass-dem.tif", &fs::read(&dem).unwrap());
        storage.put("in/pass.osm.pbf", &fs::read(&osm).unwrap());
        let inputs = ["--dem", text(&dem), "--osm", text(&osm), "-q", "-o", text(&package)];
        succeed(corniche([&["build"], &inputs[..], &options].concat()));
        let whole = fs::read(package).unwrap();
        let planned = Self { storage, folder, plan, tmp, options, whole };
        succeed(planned.plan_with(&options, &planned.plan));
        Some(planned)
    }

    fn plan_with(&self, options: &[&str], plan: &Path) -> Ran {
        let inputs = ["--dem", "s3://maps/in/pass-dem.tif", "--osm", "s3://maps/in/pass.osm.pbf"];
        self.run(&[&["plan"], &inputs[..], options, &["-o", text(plan)]].concat())
    }

    fn run(&self, arguments: &[&str]) -> Ran {
        self.command(arguments).output().unwrap().into()
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = self.storage.command();
        command.args(arguments);
        command
    }

    fn subtrees(&self) -> Vec<String> {
        let inputs = ["--dem", "s3://maps/in/pass-dem.tif", "--osm", "s3://maps/in/pass.osm.pbf"];
        let command = [&["plan", "--subtrees", "1"], &inputs[..], &self.options].concat();
        succeed(self.run(&command)).out.lines().map(str::to_owned).collect()
    }

    fn part<'a>(&'a self, step: &'a str, subtree: Option<&'a str>) -> Vec<&'a str> {
        let mut command = vec!["part", text(&self.plan), "--threads", "2", "--step", step];
        command.extend(subtree.into_iter().flat_map(|subtree| ["--subtree", subtree]));
        command.extend(["--store", STORE, "--tmp", text(&self.tmp)]);
        command
    }

    fn make(&self, step: &str, subtree: Option<&str>) -> Ran {
        succeed(self.run(&self.part(step, subtree)))
    }

    fn merge(&self, output: &str, options: &[&str]) -> Ran {
        let command = ["merge", text(&self.plan), "-o", output, "--store", STORE];
        self.run(&[&command[..], &["--tmp", text(&self.tmp)], options].concat())
    }

    /// The package of the parts in the store is that of the ordinary build, and no other files
    /// remain.
    fn check_merged(&self) {
        let package = self.folder.path().join("merged.pmtiles");
        succeed(self.merge(text(&package), &["-q"]));
        assert!(fs::read(&package).unwrap() == self.whole, "another package than build makes");
        fs::remove_file(package).unwrap();
        self.check_clean();
    }

    fn check_clean(&self) {
        assert_eq!(fs::read_dir(&self.tmp).unwrap().count(), 0, "something is left in --tmp");
        assert_eq!(self.storage.uploads(), [""; 0], "uploads are left");
        let keys = self.storage.keys().into_iter();
        let others: Vec<String> = keys
            .filter(|key| !key.starts_with("alps/build/parts/"))
            .filter(|key| !key.starts_with("in/") && !key.ends_with(".pmtiles"))
            .collect();
        assert_eq!(others, ["alps/build/plan.json", "alps/build/store"]);
    }

    /// The number of parts of this name in the store.
    fn count(&self, part: &str) -> usize {
        let begin = format!("alps/build/parts/{part}.");
        self.storage.keys().iter().filter(|key| key.starts_with(&begin)).count()
    }

    /// Starts a part; its messages are read at its end.
    fn start(&self, step: &str, subtree: Option<&str>) -> Child {
        let mut command = self.command(&self.part(step, subtree));
        command.arg("--json-progress").stdout(Stdio::null()).stderr(Stdio::piped());
        command.spawn().unwrap()
    }

    /// Whether an unfinished part in `--tmp` has artifacts: in its `data`, or in the `journal` of
    /// the durable ones.
    fn has_artifacts(&self, file: &str) -> bool {
        let folders = fs::read_dir(&self.tmp).unwrap().flatten();
        let files = folders.filter_map(|folder| fs::read_dir(folder.path()).ok()).flatten();
        let mut files = files.flatten().map(|file| file.path());
        let is_long =
            |path: &Path| fs::metadata(path).is_ok_and(|data| data.len() > STORE_HEADER_BYTES);
        files.any(|path| path.extension().is_some_and(|end| end == file) && is_long(&path))
    }

    /// Waits until an unfinished part has artifacts in one of its files.
    fn wait_for_artifacts(&self, child: &mut Child, file: &str) {
        let begun = Instant::now();
        while !self.has_artifacts(file) && matches!(child.try_wait(), Ok(None)) {
            assert!(begun.elapsed() < Duration::from_mins(2), "no tile is made");
            thread::sleep(Duration::from_millis(1));
        }
    }
}

#[track_caller]
fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}", ran.err);
    ran
}

/// Kills a part, and returns its messages.
fn kill(mut child: Child) -> Ran {
    child.kill().unwrap();
    ended(&mut child)
}

/// Inputs, store and package are all in object storage; some parts are computed one by one, some
/// concurrently, some twice.
#[test]
fn a_build_on_object_storage_makes_the_bytes_of_a_build() {
    let Some(planned) = Planned::new(COARSE) else { return };
    let quarters = planned.subtrees();
    assert_eq!(quarters.len(), 4);
    let made = planned.make("hashes", None);
    assert!(made.out.starts_with("s3://maps/alps/build/parts/hashes."), "{}", made.out);
    assert!(made.err.contains("object storage:") && made.err.contains("GET"), "{}", made.err);
    let again = planned.make("hashes", None);
    assert_eq!(again.out, "", "it is there already");
    planned.make("roads", None);
    for subtree in &quarters {
        planned.make("heights", Some(subtree));
    }
    // Two processes compute the same part concurrently.
    let both = [planned.start("top", None), planned.start("top", None)];
    for mut child in both {
        succeed(ended(&mut child));
    }
    let early = planned.merge(text(&planned.folder.path().join("early.pmtiles")), &[]);
    assert_eq!(early.code, 1, "{}", early.err);
    assert!(early.err.contains("--step tiles"), "{}", early.err);
    let begun: Vec<Child> =
        quarters.iter().chain(&quarters).map(|id| planned.start("tiles", Some(id))).collect();
    for mut child in begun {
        succeed(ended(&mut child));
    }
    for part in ["hashes", "roads", "top"] {
        assert_eq!(planned.count(part), 1, "{part}");
    }
    assert_eq!(planned.storage.keys().iter().filter(|key| key.contains("/parts/")).count(), 11);
    planned.check_merged();

    // The package is uploaded, too: complete, once, and overwritten only on request.
    let merge = |options: &[&str]| planned.merge("s3://maps/alps/pass.pmtiles", options);
    succeed(merge(&[]));
    assert!(planned.storage.get("alps/pass.pmtiles").unwrap() == planned.whole);
    let refused = merge(&[]);
    assert_eq!(refused.code, 3, "{}", refused.err);
    assert!(refused.err.contains("s3://maps/alps/pass.pmtiles"), "{}", refused.err);
    planned.storage.put("alps/pass.pmtiles", b"an older one");
    succeed(merge(&["-O"]));
    assert!(planned.storage.get("alps/pass.pmtiles").unwrap() == planned.whole);
    planned.check_clean();
}

/// The heights of the whole sample have 10 MB; anything above 8 MiB is uploaded in several
/// requests.
#[test]
fn a_large_part_is_sent_in_pieces() {
    let Some(planned) = Planned::new(COARSE) else { return };
    // A new machine has no such folder.
    fs::remove_dir(&planned.tmp).unwrap();
    planned.make("heights", None);
    // The tag of a multipart upload contains the number of parts.
    let tags = planned.storage.etags("alps/build/parts/");
    assert!(tags.len() == 1 && tags[0].contains("-2"), "{tags:?}");
    for step in ["hashes", "roads", "top", "tiles"] {
        planned.make(step, None);
    }
    planned.check_merged();
}

#[test]
fn stores_and_inputs_that_are_others_are_refused() {
    let Some(planned) = Planned::new(COARSE) else { return };
    planned.make("hashes", None);
    let other = planned.folder.path().join("other.json");
    succeed(planned.plan_with(&["--max-error", "5"], &other));
    let command = |plan: &Path, store: &str| {
        planned.run(&[
            "part",
            text(plan),
            "--step",
            "hashes",
            "--store",
            store,
            "--tmp",
            text(&planned.tmp),
        ])
    };
    let refused = command(&other, STORE);
    assert_eq!(refused.code, 2, "{}", refused.err);
    assert!(refused.err.contains("--max-error is 5"), "{}", refused.err);
    let nowhere = command(&planned.plan, "s3://mops/build");
    assert_eq!(nowhere.code, 2, "{}", nowhere.err);
    assert!(
        nowhere.err.contains("mops") && !nowhere.err.contains("not-to-be-told"),
        "{}",
        nowhere.err
    );
    let taken = command(&planned.plan, "s3://maps/in");
    assert_eq!(taken.code, 1, "{}", taken.err);
    assert!(taken.err.contains("in/pass"), "{}", taken.err);
    let no_merge = planned.run(&[
        "merge",
        text(&planned.plan),
        "--store",
        "s3://maps/none",
        "-o",
        "x.pmtiles",
    ]);
    assert_eq!(no_merge.code, 2, "{}", no_merge.err);
    // Another input makes another plan, because its ETag differs.
    let mut dem = fs::read(sample("pass/pass-dem.tif")).unwrap();
    dem.push(0);
    planned.storage.put("in/pass-dem.tif", &dem);
    let changed = command(&planned.plan, STORE);
    assert_eq!(changed.code, 2, "{}", changed.err);
    assert!(changed.err.contains("pass-dem.tif"), "{}", changed.err);
}

/// If a part is killed while it is computed, it is resumed; if it is killed during the upload, it
/// is uploaded again. The store is unchanged until then.
#[test]
fn a_part_that_is_killed_is_made_and_sent_by_the_next() {
    let Some(planned) = Planned::new(FINE) else { return };
    for step in ["hashes", "roads", "heights", "top"] {
        planned.make(step, None);
    }
    let mut child = planned.start("tiles", None);
    planned.wait_for_artifacts(&mut child, "data");
    // Computing all tiles may take less time than the interval after which they are durable, so
    // this interval passes while the process is suspended.
    assert!(send_signal(&child, "STOP"));
    thread::sleep(LONGER_THAN_A_SYNC);
    assert!(send_signal(&child, "CONT"));
    planned.wait_for_artifacts(&mut child, "journal");
    assert!(!went_on(&kill(child)), "nothing was there");
    assert!(planned.has_artifacts("journal"), "it was faster than the kill");
    assert_eq!(planned.count("tiles-0-0-0"), 0);

    planned.storage.proxy().close();
    let mut child = planned.start("tiles", None);
    planned.storage.proxy().wait_until_held();
    assert!(matches!(child.try_wait(), Ok(None)));
    let ran = kill(child);
    assert!(went_on(&ran), "all is made again: {}", ran.err);
    planned.storage.proxy().open();
    assert_eq!(planned.count("tiles-0-0-0"), 0);

    let mut child = planned.start("tiles", None);
    let ran = succeed(ended(&mut child));
    assert!(went_on(&ran), "all is made again: {}", ran.err);
    assert_eq!(planned.count("tiles-0-0-0"), 1);
    planned.check_merged();
}
