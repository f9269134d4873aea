//! Folders that other users have prepared: no link is followed, none of their files is deleted
//! because of its name, and no pipe blocks the program.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]
#![cfg(unix)]

use std::{
    fs,
    os::unix::fs::symlink,
    path::{Path, PathBuf},
    process::Command,
};

use e2e::{copy_pass, names, run_soon as run, sample, text};
use tempfile::TempDir;

/// A folder with a file that must stay unchanged.
struct Shared {
    folder: TempDir,
}

impl Shared {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("victim"), "mine").unwrap();
        fs::create_dir(folder.path().join("elsewhere")).unwrap();
        Self { folder }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn check_untouched(&self, case: &str) {
        assert_eq!(fs::read(self.at("victim")).unwrap(), b"mine", "{case}");
        assert_eq!(names(&self.at("elsewhere")), [""; 0], "{case}");
    }
}

fn pipe(place: &Path) {
    assert!(Command::new("mkfifo").arg(place).status().unwrap().success());
}

/// A build of the sample's terrain to a package, which must be rejected with these words.
fn build_refused(shared: &Shared, more: &[&str], words: &[&str], case: &str) {
    let (dem, package) = (sample("pass/pass-dem.tif"), shared.at("o.pmtiles"));
    let line = ["build", "-q", "--max-error", "20", "--dem", text(&dem), "-o", text(&package)];
    let ran = run(&[&line, more].concat());
    assert!(matches!(ran.code, 1 | 2), "{case} {more:?}: {} {}", ran.code, ran.err);
    for word in words {
        assert!(ran.err.contains(word), "{case} {more:?}: no {word:?} in {}", ran.err);
    }
    assert!(!package.exists(), "{case} {more:?}");
    shared.check_untouched(case);
}

#[test]
fn a_lock_that_others_prepared_is_refused_by_name() {
    type Put = fn(&Shared, &Path);
    let puts: [(&str, Put, &str); 4] = [
        ("a link", |shared, lock| symlink(shared.at("victim"), lock).unwrap(), "link"),
        ("a second name", |shared, lock| fs::hard_link(shared.at("victim"), lock).unwrap(), "lock"),
        ("a pipe", |_, lock| pipe(lock), "pipe"),
        ("words of others", |_, lock| fs::write(lock, "mine").unwrap(), "lock"),
    ];
    for (case, put, word) in puts {
        let shared = Shared::new();
        fs::create_dir(shared.at(".o.pmtiles.work")).unwrap();
        put(&shared, &shared.at(".o.pmtiles.work/lock"));
        for more in [&[][..], &["-O"], &["--resume"]] {
            build_refused(&shared, more, &[".o.pmtiles.work", word], case);
        }
        // The claim of the package itself.
        let shared = Shared::new();
        put(&shared, &shared.at(".o.pmtiles.unfinished"));
        build_refused(&shared, &["-O"], &[".o.pmtiles.unfinished\" is in the way"], case);
        // The store of a part.
        let shared = Shared::new();
        let (dem, plan, store) =
            (sample("pass/pass-dem.tif"), shared.at("plan.json"), shared.at("store"));
        let planned = ["plan", "-q", "--max-error", "20", "--dem", text(&dem), "-o", text(&plan)];
        assert_eq!(run(&planned).code, 0);
        fs::create_dir(&store).unwrap();
        put(&shared, &store.join("lock"));
        let part = [
            "part",
            text(&plan),
            "--store",
            text(&store),
            "--step",
            "heights",
            "--subtree",
            "0/0/0",
        ];
        let ran = run(&part);
        assert!(ran.code == 1 && ran.err.contains(word), "{case}: {} {}", ran.code, ran.err);
        shared.check_untouched(case);
    }
}

#[test]
fn the_folder_of_a_build_is_no_link() {
    let shared = Shared::new();
    symlink("elsewhere", shared.at(".o.pmtiles.work")).unwrap();
    for more in [&[][..], &["-O"], &["--resume"]] {
        build_refused(
            &shared,
            more,
            &[".o.pmtiles.work", "it is a symbolic link"],
            "a linked folder",
        );
    }
}

/// Files with these names that were not written by Corniche.
#[test]
fn a_discarded_store_is_one_by_its_content() {
    for name in ["store", "plan.json"] {
        let shared = Shared::new();
        fs::create_dir(shared.at(".o.pmtiles.work")).unwrap();
        fs::write(shared.at(".o.pmtiles.work").join(name), "mine").unwrap();
        build_refused(&shared, &["-O"], &[".o.pmtiles.work", name], name);
        assert_eq!(fs::read(shared.at(".o.pmtiles.work").join(name)).unwrap(), b"mine");
        assert_eq!(names(&shared.at(".o.pmtiles.work")), [name]);
    }
}

/// Names that older versions gave their folders; and an error deletes nothing.
#[test]
fn what_lies_beside_the_target_of_an_export_stays() {
    let shared = Shared::new();
    let package = shared.at("pass.pmtiles");
    copy_pass(&package, &["--quiet", "--dem-vertical-crs", "EPSG:5773"]);
    fs::create_dir(shared.at("full")).unwrap();
    fs::write(shared.at("full/thesis"), "mine").unwrap();
    let of_others: Vec<String> = ["roads.gpkg", "tiles", "full"]
        .into_iter()
        .flat_map(|name| [format!(".{name}.unfinished.files"), format!(".{name}.replaced")])
        .collect();
    for name in &of_others {
        fs::create_dir(shared.at(name)).unwrap();
        fs::write(shared.at(name).join("thesis"), "mine").unwrap();
        fs::write(shared.at(name).join("corniche-export.txt"), "").unwrap();
    }
    for (what, target, code) in
        [("roads", "roads.gpkg", 0), ("3dtiles", "tiles", 0), ("3dtiles", "full", 2)]
    {
        let ran = run(&["export", what, text(&package), "-o", text(&shared.at(target))]);
        assert_eq!(ran.code, code, "{target}: {}", ran.err);
        if code == 0 {
            assert!(ran.err.contains(&format!(".{target}.replaced\" may be")), "{}", ran.err);
        }
    }
    for name in &of_others {
        assert_eq!(fs::read(shared.at(name).join("thesis")).unwrap(), b"mine", "{name}");
    }
    // The temporary file does not have such a name, either.
    fs::write(shared.at(".a.svg.unfinished"), "mine").unwrap();
    let ran = run(&["growth", text(&package), "--svg", text(&shared.at("a.svg"))]);
    assert!(ran.code == 2 && ran.err.contains(".a.svg.unfinished\" is in the way"), "{}", ran.err);
    assert_eq!(fs::read(shared.at(".a.svg.unfinished")).unwrap(), b"mine");
}

#[test]
fn a_pipe_as_a_plan_or_a_part_is_refused_at_once() {
    let shared = Shared::new();
    let (dem, plan, store) =
        (sample("pass/pass-dem.tif"), shared.at("plan.json"), shared.at("store"));
    pipe(&plan);
    let part =
        ["part", text(&plan), "--store", text(&store), "--step", "heights", "--subtree", "0/0/0"];
    let ran = run(&part);
    assert!(ran.code == 2 && ran.err.contains("pipe"), "{} {}", ran.code, ran.err);
    fs::remove_file(&plan).unwrap();
    let planned = ["plan", "-q", "--max-error", "20", "--dem", text(&dem), "-o", text(&plan)];
    assert_eq!(run(&planned).code, 0);
    assert_eq!(run(&part).code, 0);
    let sealed = names(&store.join("parts"));
    pipe(&store.join("parts").join(sealed[0].replacen("heights", "heights-2", 1)));
    let ran = run(&part);
    assert!(ran.code == 1 && ran.err.contains("a pipe"), "{} {}", ran.code, ran.err);
}
