//! `--die-with-parent`: a part, and a merge, end when their stdin is closed, and only then. Their
//! progress is resumed.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]
#![cfg(unix)]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use e2e::{Ran, binary, corniche, ended, sample, text};
use tempfile::TempDir;

/// Bytes at the beginning of a journal, before its first entry.
const JOURNAL_HEADER_BYTES: u64 = 48;
/// A run may need ten seconds and a half to end; the machine may be busy.
const ENDS_WITHIN: Duration = Duration::from_secs(15);

/// A plan of the sample `pass`.
struct Planned {
    folder: TempDir,
    plan: PathBuf,
}

impl Planned {
    fn new(options: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let plan = folder.path().join("plan.json");
        let [dem, osm] = ["pass/pass-dem.tif", "pass/pass.osm.pbf"].map(sample);
        let inputs = ["--dem", text(&dem), "--osm", text(&osm)];
        succeed(&corniche(["plan", "-o", text(&plan)].iter().chain(&inputs).chain(options)));
        Self { folder, plan }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A part in `store`, made by one thread.
    fn part(&self, store: &Path, step: &str, more: &[&str]) -> Command {
        let mut command = Command::new(binary());
        command.args(["part", text(&self.plan), "--threads", "1", "--step", step]);
        command.args(["--json-progress", "--store", text(store)]).args(more);
        command
    }

    fn make(&self, store: &Path, steps: &[&str]) {
        for step in steps {
            succeed(&self.part(store, step, &[]).output().unwrap().into());
        }
    }
}

fn succeed(ran: &Ran) {
    assert_eq!(ran.code, 0, "{}", ran.err);
}

/// Starts a command with a pipe to its stdin.
fn start(command: &mut Command) -> Child {
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Files of a folder, and of sealed parts in it, with this suffix and their lengths, ascending. The
/// lock file is skipped.
fn named(store: &Path, ending: &str) -> Vec<(String, u64)> {
    let entries = [store.to_path_buf(), store.join("parts")].into_iter();
    let files = entries.filter_map(|folder| fs::read_dir(folder).ok()).flatten().flatten();
    let named = files.filter_map(|entry| {
        let name = entry.file_name().into_string().ok()?;
        let about = entry.metadata().ok()?;
        (about.is_file() && name != "lock" && name.ends_with(ending)).then_some((name, about.len()))
    });
    let mut named: Vec<(String, u64)> = named.collect();
    named.sort();
    named
}

/// Waits until an unfinished part has durable work.
fn wait_for_work(store: &Path, child: &mut Child) {
    let begun = Instant::now();
    while !named(store, ".journal").iter().any(|(_, bytes)| *bytes > JOURNAL_HEADER_BYTES) {
        assert!(begun.elapsed() < Duration::from_mins(1), "nothing becomes durable");
        assert!(child.try_wait().unwrap().is_none(), "it ended before its work was durable");
        thread::sleep(Duration::from_millis(5));
    }
}

#[test]
#[ignore = "slow: waits for processes that end"]
fn a_part_ends_when_its_pipe_closes_and_is_gone_on_with() {
    // The work takes so long that some becomes durable, every two seconds, before it is complete.
    let planned = Planned::new(&["--max-error", "0.1", "--cell", "4"]);
    let [store, aside] = ["store", "aside"].map(|name| planned.path(name));
    let before = ["hashes", "roads", "heights", "top"];
    planned.make(&store, &before);
    planned.make(&aside, &before);
    planned.make(&aside, &["tiles"]);

    let mut child = start(&mut planned.part(&store, "tiles", &["--die-with-parent"]));
    wait_for_work(&store, &mut child);
    assert!(child.try_wait().unwrap().is_none(), "the pipe is open");
    let closed = Instant::now();
    drop(child.stdin.take());
    let ran = ended(&mut child);
    assert!(closed.elapsed() < ENDS_WITHIN, "it took {:?} to end", closed.elapsed());
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert!(ran.err.contains("stdin was closed"), "{}", ran.err);
    assert_eq!(named(&store, ".part").len(), before.len(), "no half part is sealed");

    let mut child = start(&mut planned.part(&store, "tiles", &["--die-with-parent"]));
    let pipe = child.stdin.take();
    let ran = ended(&mut child);
    drop(pipe);
    succeed(&ran);
    let mut already = ran.err.lines().filter_map(|line| line.split_once("\"already\":"));
    assert!(already.any(|(_, rest)| !rest.starts_with('0')), "it began again: {}", ran.err);
    assert_eq!(named(&store, ".part"), named(&aside, ".part"), "the same as without a stop");
    assert_eq!(named(&store, ".journal"), []);
}

#[test]
fn without_the_option_the_end_of_standard_input_means_nothing() {
    let planned = Planned::new(&["--max-error", "10"]);
    let store = planned.path("store");
    let mut child = start(&mut planned.part(&store, "roads", &[]));
    drop(child.stdin.take());
    succeed(&ended(&mut child));
    assert_eq!(named(&store, ".part").len(), 1);
}

#[test]
fn a_merge_ends_when_its_pipe_closes_and_leaves_nothing() {
    let planned = Planned::new(&["--max-error", "10"]);
    let [store, package] = ["store", "out.pmtiles"].map(|name| planned.path(name));
    planned.make(&store, &["hashes", "roads", "heights", "top", "tiles"]);
    let before = named(&store, "");
    let merge = |stdin: Stdio| {
        let mut command = Command::new(binary());
        command.args(["merge", text(&planned.plan), "-q", "--die-with-parent"]);
        command.args(["--store", text(&store), "-o", text(&package)]);
        command.stdin(stdin).stderr(Stdio::piped()).spawn().unwrap()
    };
    let ran = ended(&mut merge(Stdio::null()));
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert!(ran.err.contains("stdin was closed"), "{}", ran.err);
    let around = named(planned.folder.path(), "");
    assert!(matches!(&around[..], [(plan, _)] if plan == "plan.json"), "{around:?}");
    assert_eq!(named(&store, ""), before, "the store is as it was");

    let mut child = merge(Stdio::piped());
    let pipe = child.stdin.take();
    succeed(&ended(&mut child));
    drop(pipe);
    assert!(package.exists());
}
