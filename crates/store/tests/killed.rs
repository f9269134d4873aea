//! Runs alone in its process: a child process that is about to start shares the locks of other
//! tests for a moment.
#![allow(clippy::unwrap_used, reason = "tests may unwrap")]

#[path = "it/common.rs"]
mod common;

use std::{
    path::Path,
    thread,
    time::{Duration, Instant},
};

use common::*;
use corniche_store::{Artifacts, LocalStore};

/// A real process is killed at some moment: the kernel releases its lock, and its artifacts exist.
/// Ten times with one store.
#[test]
fn a_process_that_is_killed_leaves_a_store_to_go_on_from() {
    const FOLDER: &str = "CORNICHE_TEST_STORE";
    const NAME: &str = "a_process_that_is_killed_leaves_a_store_to_go_on_from";
    if let Some(folder) = std::env::var_os(FOLDER) {
        // This is the process that is killed.
        let store = LocalStore::open(system(), Path::new(&folder), &plan().hash, ALWAYS).unwrap();
        for item in store.items(1).len() as u64..100_000 {
            store.put(key(1, item), &artifact(key(1, item))).unwrap();
        }
        return;
    }
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path().join("store");
    drop(LocalStore::create(system(), &folder, &plan(), ALWAYS).unwrap());
    let mut count = 0;
    for round in 1..=10 {
        let journal_bytes = || {
            let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap());
            let mut journals =
                files.filter(|file| file.path().extension().is_some_and(|end| end == "journal"));
            journals.next().map_or(0, |journal| journal.metadata().unwrap().len())
        };
        let enough = journal_bytes().max(48) + 32 * (5 + round);
        let mut child = std::process::Command::new(std::env::current_exe().unwrap())
            .args(["--exact", NAME])
            .env(FOLDER, &folder)
            .stdout(std::process::Stdio::null())
            .spawn()
            .unwrap();
        let start = Instant::now();
        while journal_bytes() < enough && start.elapsed() < Duration::from_mins(1) {
            thread::sleep(Duration::from_millis(1));
        }
        let second = LocalStore::open(system(), &folder, &plan().hash, NEVER);
        child.kill().unwrap();
        child.wait().unwrap();
        let owner = format!("process {} on ", child.id());
        let error = second.unwrap_err();
        assert!(error.to_string().contains(&owner), "{error}");

        let store = LocalStore::open(system(), &folder, &plan().hash, NEVER).unwrap();
        let now = check_all_right(&store);
        assert!(now >= count + 5, "{now} after {count}");
        assert!(store.items(1).into_iter().eq(0..now as u64));
        count = now;
    }
}
