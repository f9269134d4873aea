//! Sealed parts, written by several processes, in any order, some of them twice, are read together.
#![allow(clippy::unwrap_used, reason = "tests may unwrap")]

use std::path::{Path, PathBuf};

use crate::common::*;
use corniche_store::{
    ArtifactKey, Artifacts, Folder, LocalStore, OwnPart, SealedParts, StoreError, StoredPlan,
};
use corniche_testing::{Random, disks::MemoryDisk};

fn own<'a>(folder: &'a Path, name: &'a str, plan: &'a StoredPlan) -> OwnPart<'a> {
    OwnPart { folder, name, plan, interval: NEVER }
}

fn open_part(disk: &MemoryDisk, folder: &Path, name: &str) -> Result<LocalStore, StoreError> {
    open_parts(disk.disk(), &[], &plan().hash, Some(own(folder, name, &plan())))
}

/// Writes and seals a part with `keys`, in this order.
fn make_part(disk: &MemoryDisk, folder: &Path, name: &str, keys: &[ArtifactKey]) -> PathBuf {
    let store = open_part(disk, folder, name).unwrap();
    for &key in keys {
        store.put(key, &artifact(key)).unwrap();
    }
    store.seal().unwrap().unwrap()
}

fn keys(kind: u8, items: std::ops::Range<u64>) -> Vec<ArtifactKey> {
    items.map(|item| key(kind, item)).collect()
}

#[test]
fn parts_of_several_folders_are_read_as_one() {
    let disk = empty_disk();
    let [first, second] = [Path::new("/data/first"), Path::new("/data/second")];
    make_part(&disk, first, "heights-1-0-0", &keys(1, 0..40));
    make_part(&disk, first, "heights-1-1-0", &keys(1, 40..70));
    make_part(&disk, second, "roads", &keys(2, 0..3000));
    let store = open_parts(disk.disk(), &[first, second], &plan().hash, None).unwrap();
    let all = all_of(keys(1, 0..70).into_iter().chain(keys(2, 0..3000)));
    check_holds(&store, &all);
    let error = store.put(key(3, 0), b"more").unwrap_err();
    assert!(matches!(error, StoreError::ReadOnly { .. }), "{error}");
    // Existing artifacts need not be stored again.
    store.put(key(2, 0), b"same").unwrap();

    // The same with an own part, which may be in a third folder.
    let (folder, plan) = (Path::new("/data/third"), plan());
    let own = own(folder, "merge", &plan);
    let store = open_parts(disk.disk(), &[first, second], &plan.hash, Some(own)).unwrap();
    store.put(key(5, 0), &artifact(key(5, 0))).unwrap();
    let mut all = all;
    all.extend(all_of([key(5, 0)]));
    check_holds(&store, &all);
}

/// Parts that are not needed are not even opened: a damaged one is no error then.
#[test]
fn parts_that_are_not_wanted_are_as_if_they_were_not_there() {
    let disk = empty_disk();
    let folder = Path::new("/data/first");
    make_part(&disk, folder, "heights-1-0-0", &keys(1, 0..40));
    let roads = make_part(&disk, folder, "roads", &keys(2, 0..3000));
    let place = Folder::new(disk.disk(), folder);
    let open = |is_needed: &dyn Fn(&str) -> bool| {
        let sealed = SealedParts { places: &[&place], is_needed };
        LocalStore::open_places(disk.disk(), sealed, &plan().hash, None)
    };
    check_holds(&open(&|name| name == "heights-1-0-0").unwrap(), &all_of(keys(1, 0..40)));
    check_holds(&open(&|name| name.len() == 5).unwrap(), &all_of(keys(2, 0..3000)));
    let bytes = disk.content(&roads).unwrap();
    disk.set_content(&roads, &bytes[..100]);
    check_holds(&open(&|name| name != "roads").unwrap(), &all_of(keys(1, 0..40)));
    assert!(matches!(open(&|_| true).unwrap_err(), StoreError::Damaged { .. }));
}

/// The name of a part depends on its content, not on the order in which its artifacts were stored,
/// and a second copy is deleted.
#[test]
fn a_part_made_twice_is_one_file() {
    let disk = empty_disk();
    let mut keys = keys(1, 0..100);
    let first = make_part(&disk, Path::new("/data/a"), "heights", &keys);
    let mut random = Random::new(3);
    for last in (1..keys.len()).rev() {
        keys.swap(last, random.below(last as i64 + 1) as usize);
    }
    let second = make_part(&disk, Path::new("/data/b"), "heights", &keys);
    assert_eq!(first.file_name(), second.file_name());
    let fewer = make_part(&disk, Path::new("/data/c"), "heights", &keys[1..]);
    assert_ne!(first.file_name(), fewer.file_name());

    // Two parts at once in one folder: neither process sees the other part before both are sealed.
    let folder = Path::new("/data/d");
    let stores = [(); 2].map(|()| open_part(&disk, folder, "heights").unwrap());
    for store in &stores {
        for &key in &keys {
            store.put(key, &artifact(key)).unwrap();
        }
    }
    let paths = stores.map(|store| store.seal().unwrap().unwrap());
    assert_eq!(paths[0], paths[1]);
    assert_eq!(paths[0].file_name(), first.file_name());
    let there: Vec<_> = disk.paths().into_iter().filter(|path| path.starts_with(folder)).collect();
    assert_eq!(
        there,
        ["lock", &format!("parts/{}", first.file_name().unwrap().display()), "plan.json", "store"]
            .map(|name| folder.join(name))
    );
}

#[test]
fn a_part_that_was_sealed_is_not_made_again() {
    let disk = empty_disk();
    make_part(&disk, folder(), "roads", &keys(1, 0..10));
    let store = open_part(&disk, folder(), "roads").unwrap();
    check_holds(&store, &all_of(keys(1, 0..10)));
    for key in keys(1, 0..10) {
        store.put(key, &artifact(key)).unwrap();
    }
    assert_eq!(store.seal().unwrap(), None);
    assert_eq!(disk.paths().len(), 4);
}

#[test]
fn a_killed_part_is_gone_on_with_by_the_next_process_of_its_name_only() {
    let disk = empty_disk();
    let store = open_part(&disk, folder(), "heights").unwrap();
    for key in keys(1, 0..10) {
        store.put(key, &artifact(key)).unwrap();
    }
    store.flush().unwrap();
    let files = disk.paths().len();
    // While the first process lives, a second one writes its own part, and finds none of the first
    // one's artifacts.
    let second = open_part(&disk, folder(), "heights").unwrap();
    assert_eq!(second.items(1), NO_ITEMS);
    drop(second);

    let killed = disk.after_kill();
    assert_eq!(open_part(&killed, folder(), "roads").unwrap().items(1), NO_ITEMS);
    let store = open_part(&killed, folder(), "heights").unwrap();
    check_holds(&store, &all_of(keys(1, 0..10)));
    store.put(key(1, 10), &artifact(key(1, 10))).unwrap();
    let path = store.seal().unwrap().unwrap();
    assert_eq!(path, make_part(&empty_disk(), folder(), "heights", &keys(1, 0..11)));
    // The journal and the data of `roads` still exist, and nothing of `heights`.
    assert_eq!(killed.paths().len(), files - 2 + 2 + 1);
}

/// The killed part with the most artifacts is resumed, and the others are deleted.
#[test]
fn the_longest_of_several_killed_parts_is_gone_on_with() {
    for counts in [[3, 9, 5], [9, 1, 0], [0, 0, 9]] {
        let disk = empty_disk();
        let stores = counts.map(|count| {
            let store = open_part(&disk, folder(), "heights").unwrap();
            for key in keys(1, 0..count) {
                store.put(key, &artifact(key)).unwrap();
            }
            store.flush().unwrap();
            store
        });
        let killed = disk.after_kill();
        drop(stores);
        let store = open_part(&killed, folder(), "heights").unwrap();
        check_holds(&store, &all_of(keys(1, 0..9)));
        assert_eq!(killed.paths().len(), 5, "{:?}", killed.paths());
    }
}

#[test]
fn parts_of_another_plan_are_refused_by_name() {
    let disk = empty_disk();
    let [first, second] = [Path::new("/data/first"), Path::new("/data/second")];
    make_part(&disk, first, "heights", &keys(1, 0..4));
    let other = StoredPlan { hash: [9; 32], bytes: Vec::new() };
    let store =
        open_parts(disk.disk(), &[], &other.hash, Some(own(second, "roads", &other))).unwrap();
    store.put(key(2, 0), b"of the other plan").unwrap();
    let path = store.seal().unwrap().unwrap();

    let both = [first, second];
    let error = open_parts(disk.disk(), &both, &plan().hash, None).unwrap_err();
    assert!(matches!(&error, StoreError::OtherPlan { path } if path == second), "{error}");
    // A copy in the right folder is still the wrong part.
    let copy = first.join("parts").join(path.file_name().unwrap());
    disk.set_content(&copy, &disk.content(&path).unwrap());
    let error = open_parts(disk.disk(), &[first], &plan().hash, None).unwrap_err();
    assert!(matches!(&error, StoreError::OtherPlan { path } if *path == copy), "{error}");
}

#[test]
fn two_parts_that_contradict_each_other_are_refused() {
    let disk = empty_disk();
    let [first, second] = [Path::new("/data/first"), Path::new("/data/second")];
    make_part(&disk, first, "heights", &keys(1, 0..4));
    let store = open_part(&disk, second, "heights").unwrap();
    store.put(key(1, 2), b"not what the plan gives").unwrap();
    store.seal().unwrap();
    let both = [first, second];
    let error = open_parts(disk.disk(), &both, &plan().hash, None).unwrap_err();
    assert!(matches!(error, StoreError::Differs { kind: 1, item: 2, .. }), "{error}");
}

/// Any wrong byte of a sealed part causes an error that names the part, on opening or when the
/// artifact is read.
#[test]
fn any_wrong_byte_of_a_sealed_part_is_noticed() {
    let disk = empty_disk();
    let path = make_part(&disk, folder(), "heights", &keys(1, 0..5));
    let bytes = disk.content(&path).unwrap();
    // The zeros in the footer have no meaning.
    let meaningless = bytes.len() - 12..bytes.len() - 8;
    for at in (0..bytes.len()).filter(|at| !meaningless.contains(at)) {
        let mut wrong = bytes.clone();
        wrong[at] ^= 0x20;
        disk.set_content(&path, &wrong);
        let opened = open_parts(disk.disk(), &[folder()], &plan().hash, None);
        let error = match opened {
            Err(error) => error,
            Ok(store) => keys(1, 0..5).into_iter().find_map(|key| store.get(key).err()).unwrap(),
        };
        let names_it = match &error {
            StoreError::Damaged { path: found, .. }
            | StoreError::OtherPlan { path: found }
            | StoreError::OtherVersion { path: found, .. } => *found == path,
            _ => false,
        };
        assert!(names_it, "byte {at}: {error}");
    }
    for length in [0, 10, 48, 60, bytes.len() - 1] {
        disk.set_content(&path, &bytes[..length]);
        let error = open_parts(disk.disk(), &[folder()], &plan().hash, None).unwrap_err();
        assert!(matches!(&error, StoreError::Damaged { .. }), "{error}");
        let said = error.to_string();
        assert!(said.contains("delete the file and create the part again"), "{said}");
    }
}

#[test]
fn a_build_and_parts_do_not_work_in_one_folder_at_once() {
    let disk = empty_disk();
    let build = create(&disk, NEVER).unwrap();
    let error = open_part(&disk, folder(), "roads").unwrap_err();
    assert!(matches!(error, StoreError::Locked { .. }), "{error}");
    drop(build);
    let first = open_part(&disk, folder(), "roads").unwrap();
    let second = open_part(&disk, folder(), "heights").unwrap();
    let error = open(&disk, NEVER).unwrap_err();
    assert!(matches!(error, StoreError::Locked { .. }), "{error}");
    let error = first.remove().unwrap_err();
    assert!(matches!(error, StoreError::Locked { .. }), "{error}");
    assert_eq!(second.remove().unwrap(), NOTHING);
    assert_eq!(disk.paths(), NOTHING);
}

#[test]
fn a_name_that_is_no_file_name_is_refused() {
    let disk = empty_disk();
    for name in ["", "a/b", "..", "heights.1", "a b"] {
        let error = open_part(&disk, folder(), name).unwrap_err();
        assert!(matches!(error, StoreError::PartName { .. }), "{error}");
    }
    assert_eq!(disk.paths(), NOTHING);
}

/// Two processes on the file system of the machine, simulated by one test process: locks are held
/// by open files.
#[test]
fn parts_work_on_the_file_system_of_the_machine() {
    let temporary = tempfile::tempdir().unwrap();
    let (folder, plan) = (temporary.path().join("store"), plan());
    let open =
        |name| open_parts(system(), &[], &plan.hash, Some(own(&folder, name, &plan))).unwrap();
    let stores = [open("heights"), open("heights"), open("roads")];
    for (store, kind) in stores.iter().zip([1, 1, 2]) {
        for key in keys(kind, 0..50) {
            store.put(key, &artifact(key)).unwrap();
        }
    }
    let paths = stores.map(|store| store.seal().unwrap().unwrap());
    assert_eq!(paths[0], paths[1]);
    let store = open_parts(system(), &[&folder], &plan.hash, None).unwrap();
    check_holds(&store, &all_of(keys(1, 0..50).into_iter().chain(keys(2, 0..50))));
    assert_eq!(std::fs::read_dir(folder.join("parts")).unwrap().count(), 2);
    assert_eq!(LocalStore::discard(system(), &folder).unwrap(), NOTHING);
    assert!(!folder.exists());
}
