//! The list of jobs: running all of them produces the bytes of a build.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

use e2e::{Ran, corniche, sample, some_of, text, write_ascii_grid};
use serde_json::Value;
use tempfile::TempDir;

/// A plan in a folder, and the package of an ordinary build.
struct Planned {
    folder: TempDir,
    inputs: Vec<String>,
    plan: PathBuf,
    whole: Vec<u8>,
}

impl Planned {
    fn new(inputs: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let [plan, package] = ["plan.json", "whole.pmtiles"].map(|name| folder.path().join(name));
        succeed(corniche([&["build", "-q", "-o", text(&package)], inputs].concat()));
        succeed(corniche([&["plan", "-o", text(&plan)], inputs].concat()));
        let inputs = inputs.iter().map(|&option| option.to_owned()).collect();
        Self { folder, inputs, plan, whole: fs::read(package).unwrap() }
    }

    /// Plans the sample `pass`.
    fn pass() -> Self {
        let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
        Self::new(&["--dem", text(&dem), "--osm", text(&osm), "--max-error", "10"])
    }

    fn jobs(&self, options: &[&str]) -> Vec<Value> {
        read(&succeed(corniche([&["jobs", text(&self.plan)], options].concat())))
    }

    /// Computes a job's part.
    fn make(&self, job: &Value, store: &Path) {
        let own = words(&job["args"]);
        let mut command = vec!["part", text(&self.plan), "--store", text(store), "-q"];
        command.extend(own.iter().map(String::as_str));
        succeed(corniche(command));
    }

    fn check_merged(&self, store: &Path) {
        let package = self.folder.path().join("merged.pmtiles");
        let command =
            ["merge", text(&self.plan), "-q", "-o", text(&package), "--store", text(store)];
        succeed(corniche(command));
        assert!(fs::read(&package).unwrap() == self.whole, "another package than build makes");
        fs::remove_file(package).unwrap();
    }
}

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}", ran.err);
    ran
}

/// The jobs that a command printed; checks the invariants of every list.
fn read(ran: &Ran) -> Vec<Value> {
    let jobs: Vec<Value> =
        ran.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let steps: Vec<&str> = jobs.iter().map(|job| job["step"].as_str().unwrap()).collect();
    let ids: BTreeSet<&str> = jobs.iter().map(|job| job["id"].as_str().unwrap()).collect();
    assert_eq!(ids.len(), jobs.len(), "each has a name of its own");
    for (index, job) in jobs.iter().enumerate() {
        assert!(job["work"].as_f64().unwrap() > 0.0);
        // All parts that a job waits for come before it in the list.
        for step in words(&job["after"]) {
            assert!(steps[..index].contains(&step.as_str()), "{job}");
            assert!(!steps[index..].contains(&step.as_str()), "{job}");
        }
    }
    assert_eq!(steps.last(), Some(&"merge"));
    jobs
}

fn words(list: &Value) -> Vec<String> {
    list.as_array().unwrap().iter().map(|word| word.as_str().unwrap().to_owned()).collect()
}

fn jobs_of_step<'a>(jobs: &'a [Value], step: &'a str) -> impl Iterator<Item = &'a Value> {
    jobs.iter().filter(move |job| job["step"] == step)
}

fn subtrees(jobs: &[Value], step: &str) -> BTreeMap<String, f64> {
    let one =
        |job: &Value| (job["subtree"].as_str().unwrap().to_owned(), job["work"].as_f64().unwrap());
    jobs_of_step(jobs, step).map(one).collect()
}

/// Subtrees of the step heights and those of the step tiles may differ in both directions.
#[test]
#[ignore = "slow: some twenty runs of the program"]
fn jobs_done_one_after_the_other_make_the_bytes_of_a_build() {
    let planned = Planned::pass();
    let slots = [["1", "40"], ["40", "1"], ["3", "3"]];
    for [slots_before, slots_after] in some_of(slots, [3, 3, 1]) {
        let store = planned.folder.path().join(format!("store-{slots_before}-{slots_after}"));
        let first = planned.jobs(&["--slots", slots_before, "--least-work", "0"]);
        for job in first.iter().filter(|job| job["step"] != "tiles" && job["step"] != "merge") {
            planned.make(job, &store);
        }
        let options = ["--slots", slots_after, "--least-work", "0", "--store", text(&store)];
        let again = planned.jobs(&options);
        let (heights, tiles) = (subtrees(&first, "heights"), subtrees(&again, "tiles"));
        if slots_before != slots_after {
            assert_ne!(heights.keys().collect::<Vec<_>>(), tiles.keys().collect::<Vec<_>>());
        }
        for job in jobs_of_step(&again, "tiles") {
            planned.make(job, &store);
        }
        planned.check_merged(&store);
    }
}

/// Before the roads are read, they are assumed to be evenly distributed; afterwards their
/// distribution is known.
#[test]
fn roads_in_the_store_change_the_work_of_tiles_alone() {
    let planned = Planned::pass();
    let store = planned.folder.path().join("store");
    let options = ["--slots", "9", "--least-work", "0"];
    let unknown = planned.jobs(&options);
    // A store that does not exist yet, or has no roads, has no effect.
    let options = [&options[..], &["--store", text(&store)]].concat();
    assert_eq!(planned.jobs(&options), unknown);
    planned.make(jobs_of_step(&unknown, "hashes").next().unwrap(), &store);
    assert_eq!(planned.jobs(&options), unknown);
    planned.make(jobs_of_step(&unknown, "roads").next().unwrap(), &store);
    let known = planned.jobs(&options);
    assert_ne!(subtrees(&known, "tiles"), subtrees(&unknown, "tiles"));
    assert_eq!(subtrees(&known, "heights"), subtrees(&unknown, "heights"));
    // The same again, to the last digit.
    assert_eq!(planned.jobs(&options), known);
}

/// A wide file and a narrow one far from it: parts are small where there is much data, and large
/// where there is little.
#[test]
#[ignore = "slow: plans and builds of several data"]
fn subtrees_of_uneven_data_come_from_several_levels() {
    let folder = tempfile::tempdir().unwrap();
    let [wide, narrow] = ["wide.asc", "narrow.asc"].map(|name| folder.path().join(name));
    let height = |column: usize, row: usize| ((column * 7 + row * 13) % 50) as f64;
    let place = "xllcorner 500000\nyllcorner 5000000\ncellsize 10";
    write_ascii_grid(&wide, [1200, 1200], place, height);
    let place = "xllcorner 535000\nyllcorner 5035000\ncellsize 10";
    write_ascii_grid(&narrow, [100, 100], place, height);
    let inputs =
        ["--dem", text(&wide), text(&narrow), "--dem-crs", "EPSG:32632", "--max-error", "10"];
    let planned = Planned::new(&inputs);
    let jobs = planned.jobs(&["--slots", "2", "--least-work", "0"]);
    let levels: BTreeSet<String> =
        subtrees(&jobs, "tiles").keys().map(|id| id[..1].to_owned()).collect();
    assert!(levels.len() > 1, "{levels:?}");
    // Without roads there is no step of that name, and no job waits for it.
    assert_eq!(jobs_of_step(&jobs, "roads").count(), 0);
    let store = planned.folder.path().join("store");
    for job in &jobs[..jobs.len() - 1] {
        planned.make(job, &store);
    }
    planned.check_merged(&store);
}

#[test]
fn plan_lists_the_same_jobs() {
    let planned = Planned::pass();
    let again = planned.folder.path().join("again.json");
    let command = ["plan", "-o", text(&again), "--jobs", "4"].map(str::to_owned);
    let printed = read(&succeed(corniche(command.iter().chain(&planned.inputs))));
    assert_eq!(printed, planned.jobs(&["--slots", "4"]));
    assert_eq!(fs::read(&again).unwrap(), fs::read(&planned.plan).unwrap());
    for options in [["--slots", "0"].as_slice(), &["--slots", "1", "--least-work", "-1"]] {
        let ran = corniche([&["jobs", text(&planned.plan)], options].concat());
        assert_eq!(ran.code, 2, "{}", ran.err);
    }
}

/// With the terrain of a package there are no heights to read, and the tiles are those of the
/// package.
#[test]
fn jobs_of_a_build_on_recorded_terrain_make_its_bytes() {
    let before = Planned::pass();
    let (terrain, osm) = (before.folder.path().join("whole.pmtiles"), sample("pass/pass.osm.pbf"));
    let planned = Planned::new(&["--terrain", text(&terrain), "--osm", text(&osm)]);
    let jobs = planned.jobs(&["--slots", "3", "--least-work", "0"]);
    assert_eq!(jobs_of_step(&jobs, "heights").count(), 0);
    assert!(jobs_of_step(&jobs, "tiles").count() > 3);
    let store = planned.folder.path().join("store");
    for job in &jobs[..jobs.len() - 1] {
        planned.make(job, &store);
    }
    planned.check_merged(&store);
}
