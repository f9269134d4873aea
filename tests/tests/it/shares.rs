//! An extract that several processes read: the same roads as from one process, in a part with the
//! same name.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use e2e::{Ran, corniche, sample, text};
use tempfile::TempDir;

/// A plan of the sample `pass`.
struct Planned {
    folder: TempDir,
    plan: PathBuf,
}

impl Planned {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let plan = folder.path().join("plan.json");
        let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
        let inputs = ["--dem", text(&dem), "--osm", text(&osm), "--max-error", "10"];
        succeed(&corniche([&["plan", "-o", text(&plan)], &inputs[..]].concat()));
        Self { folder, plan }
    }

    fn store(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn part(&self, store: &Path, options: &[&str]) -> Ran {
        let command = ["part", text(&self.plan), "-q", "--store", text(store)];
        corniche([&command[..], options].concat())
    }

    /// Computes the roads; returns the name of their part, which identifies its content.
    fn roads(&self, store: &Path) -> (String, Ran) {
        let ran = self.part(store, &["--step", "roads"]);
        succeed(&ran);
        let name = Path::new(ran.out.trim_end()).file_name().unwrap();
        (name.to_str().unwrap().to_owned(), ran)
    }
}

fn succeed(ran: &Ran) {
    assert_eq!(ran.code, 0, "{}", ran.err);
}

fn refused(ran: &Ran, parts: &[&str]) {
    ended_with(2, ran, parts);
}

fn ended_with(code: i32, ran: &Ran, parts: &[&str]) {
    assert_eq!(ran.code, code, "{}", ran.err);
    for part in parts {
        assert!(ran.err.contains(part), "{part}: {}", ran.err);
    }
}

#[test]
fn any_number_of_shares_makes_the_same_part_of_roads() {
    let planned = Planned::new();
    let (expected, _) = planned.roads(&planned.store("direct"));
    for of in [1, 2, 3, 7] {
        let store = planned.store(&format!("store-{of}"));
        for step in ["ways", "nodes"] {
            // The last one first, and each twice.
            for number in (1..=of).rev() {
                let share = format!("{number}/{of}");
                let options = ["--step", step, "--share", &share];
                let made = planned.part(&store, &options);
                succeed(&made);
                let name = Path::new(made.out.trim_end()).file_name().unwrap().to_str().unwrap();
                assert!(name.starts_with(&format!("{step}-{number}-{of}.")), "{name}");
                let again = planned.part(&store, &options);
                succeed(&again);
                assert_eq!(again.out, "", "it is there already");
            }
        }
        let (name, ran) = planned.roads(&store);
        assert_eq!(name, expected, "{of} shares");
        assert_eq!(ran.err, "", "all shares are there, and nothing is to be said");
        // When the roads exist, shares are not needed any more.
        let late = planned.part(&store, &["--step", "ways", "--share", "1/5"]);
        succeed(&late);
        assert_eq!(late.out, "");
    }
}

#[test]
fn shares_that_are_missing_are_named_and_the_extract_is_read_in_their_place() {
    let planned = Planned::new();
    let store = planned.store("store");
    for number in [1, 3] {
        succeed(&planned.part(&store, &["--step", "ways", "--share", &format!("{number}/3")]));
    }
    // It may be added later.
    ended_with(
        1,
        &planned.part(&store, &["--step", "nodes", "--share", "1/3"]),
        &["chunk 2/3 of the ways", "--step ways"],
    );
    let (name, ran) = planned.roads(&store);
    assert_eq!(name, planned.roads(&planned.store("direct")).0);
    assert!(ran.err.contains("some chunks of the steps"), "{}", ran.err);
}

#[test]
fn a_share_that_makes_no_sense_is_refused() {
    let planned = Planned::new();
    let store = planned.store("store");
    for share in ["0/3", "4/3", "1/257", "3", "a/b"] {
        let options = ["--step", "ways", "--share", share];
        refused(&planned.part(&store, &options), &["is not a chunk I/N"]);
    }
    let options = ["--step", "roads", "--share", "1/2"];
    refused(&planned.part(&store, &options), &["--share 1/2", "the step roads has no chunks"]);
    let options = ["--step", "ways", "--subtree", "0/0/0"];
    refused(&planned.part(&store, &options), &["--subtree 0/0/0"]);
    assert!(!store.exists() || fs::read_dir(store.join("parts")).is_err(), "nothing was made");
}
