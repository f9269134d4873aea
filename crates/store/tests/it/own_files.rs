//! Links, pipes and files with two names are not used, whoever put them there.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]
#![cfg(unix)]

use std::{
    fs,
    os::unix::fs::symlink,
    path::{Path, PathBuf},
    process::Command,
    sync::Arc,
};

use corniche_store::{
    Claim, Disk as _, Folder, LocalStore, OpenMode, PartsPlace as _, SYNC_INTERVAL, StoredPlan,
    SystemDisk, make_own_folder, sync_tree,
};

struct Prepared {
    folder: tempfile::TempDir,
    victim: PathBuf,
}

fn prepared() -> Prepared {
    let folder = tempfile::tempdir().unwrap();
    let victim = folder.path().join("victim");
    fs::write(&victim, "mine").unwrap();
    Prepared { folder, victim }
}

/// Puts something else in the position of a file.
fn put(way: &str, victim: &Path, place: &Path) {
    match way {
        "link" => symlink(victim, place).unwrap(),
        "dead link" => symlink("nowhere", place).unwrap(),
        "second name" => fs::hard_link(victim, place).unwrap(),
        "folder" => fs::create_dir(place).unwrap(),
        _ => assert!(Command::new("mkfifo").arg(place).status().unwrap().success()),
    }
}

const WAYS: [&str; 5] = ["link", "dead link", "second name", "folder", "pipe"];

#[test]
fn the_lock_of_a_store_and_the_claim_of_a_target_are_files_of_ours() {
    let plan = StoredPlan { hash: [7; 32], bytes: b"{}".to_vec() };
    for way in WAYS {
        let Prepared { folder, victim } = prepared();
        let store = folder.path().join("store");
        fs::create_dir(&store).unwrap();
        put(way, &victim, &store.join("lock"));
        let disk = Arc::new(SystemDisk);
        let made = LocalStore::create(disk.clone(), &store, &plan, SYNC_INTERVAL);
        assert!(made.is_err(), "{way}");
        assert!(LocalStore::discard(disk, &store).is_err(), "{way}");
        assert!(store.join("lock").symlink_metadata().is_ok(), "{way}");
        put(way, &victim, &folder.path().join(".x.unfinished"));
        let error = Claim::take(&folder.path().join("x")).unwrap_err();
        assert!(error.to_string().contains(".x.unfinished\" is in the way"), "{way}: {error}");
        assert_eq!(fs::read(&victim).unwrap(), b"mine", "{way}");
        assert!(!folder.path().join("nowhere").exists() && !store.join("nowhere").exists());
    }
}

#[test]
fn a_folder_of_ours_is_no_link() {
    let Prepared { folder, .. } = prepared();
    let elsewhere = folder.path().join("elsewhere");
    fs::create_dir(&elsewhere).unwrap();
    let store = folder.path().join("store");
    symlink(&elsewhere, &store).unwrap();
    let plan = StoredPlan { hash: [7; 32], bytes: b"{}".to_vec() };
    let error = LocalStore::create(Arc::new(SystemDisk), &store, &plan, SYNC_INTERVAL).unwrap_err();
    let told = std::error::Error::source(&error).map(ToString::to_string).unwrap_or_default();
    assert!(told.contains("it is a symbolic link"), "{error}: {told}");
    assert_eq!(fs::read_dir(&elsewhere).unwrap().count(), 0);
    // Later calls do not follow the link either.
    for call in [
        SystemDisk.open(&store.join("a"), OpenMode::New).map(drop),
        SystemDisk.remove(&store.join("a")),
        SystemDisk.rename(&store.join("a"), &store.join("b")),
        SystemDisk.list(&store).map(drop),
    ] {
        assert!(call.unwrap_err().to_string().contains("it is a symbolic link"));
    }
    assert!(make_own_folder(&store).unwrap_err().to_string().contains("it is a symbolic link"));
}

/// Opening a pipe would wait for a writer.
#[test]
fn a_pipe_among_the_parts_is_refused_at_once() {
    let Prepared { folder, victim } = prepared();
    let parts = folder.path().join("parts");
    fs::create_dir(&parts).unwrap();
    for (way, what) in [("pipe", "a pipe"), ("link", "a symbolic link")] {
        let name = format!("a.{}.part", way.replace(' ', ""));
        put(way, &victim, &parts.join(&name));
        let error = Folder::new(Arc::new(SystemDisk), folder.path()).open(&name).unwrap_err();
        let told = std::error::Error::source(&error).map(ToString::to_string).unwrap_or_default();
        assert!(told.contains(what), "{error}: {told}");
    }
}

/// A name proves nothing: files with the names of a store's files are kept, and so are the files
/// next to them.
#[test]
fn files_with_the_names_of_a_store_are_not_removed() {
    let own = ["store", "plan.json", "a.1-0123456789abcdef.data", "1-0123456789abcdef.scratch"];
    for name in own {
        for lock in [None, Some(""), Some("process 1 on here\n")] {
            let Prepared { folder, .. } = prepared();
            let store = folder.path().join("store");
            fs::create_dir(&store).unwrap();
            fs::write(store.join(name), "mine").unwrap();
            if let Some(lock) = lock {
                fs::write(store.join("lock"), lock).unwrap();
            }
            let error = LocalStore::discard(Arc::new(SystemDisk), &store).unwrap_err();
            assert!(error.to_string().contains(name), "{name}, {lock:?}: {error}");
            assert_eq!(fs::read(store.join(name)).unwrap(), b"mine");
        }
    }
}

#[test]
fn a_tree_that_is_durable_tells_how_many_bytes_its_files_have() {
    let folder = tempfile::TempDir::new().unwrap();
    fs::create_dir_all(folder.path().join("a/b")).unwrap();
    for (name, bytes) in [("one", 1), ("a/two", 20), ("a/b/three", 300)] {
        fs::write(folder.path().join(name), vec![7; bytes]).unwrap();
    }
    assert_eq!(sync_tree(folder.path()).unwrap(), 321);
    assert!(sync_tree(&folder.path().join("missing")).is_err());
}
