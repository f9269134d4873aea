//! A store in a folder: stored artifacts are returned at once, later, and after an incomplete end.
#![allow(clippy::unwrap_used, reason = "tests may unwrap")]

use std::{
    collections::BTreeMap,
    path::Path,
    sync::{Barrier, mpsc},
    thread,
    time::Duration,
};

use crate::common::*;
use corniche_store::{Artifacts, LocalStore, ScratchSpace, StoreError, StoredPlan};
use corniche_testing::disks::{DiskFailure, MemoryDisk};
use proptest::prelude::*;

#[derive(Debug, Clone)]
enum Step {
    Put(u8, u64),
    Flush,
    Reopen,
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let step = prop_oneof![
        20 => (0_u8..4, 0_u64..60).prop_map(|(kind, item)| Step::Put(kind, item)),
        2 => Just(Step::Flush),
        1 => Just(Step::Reopen),
    ];
    proptest::collection::vec(step, 0..120)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The store gives the same results as a map, also after it is opened again.
    #[test]
    fn store_equals_a_map(steps in steps()) {
        let disk = empty_disk();
        let mut store = create(&disk, NEVER).unwrap();
        let mut map = BTreeMap::new();
        for step in steps {
            match step {
                Step::Put(kind, item) => {
                    let key = key(kind, item);
                    store.put(key, &artifact(key)).unwrap();
                    // Storing a key again changes nothing.
                    store.put(key, b"something else").unwrap();
                    map.insert(key, artifact(key));
                }
                Step::Flush => store.flush().unwrap(),
                Step::Reopen => {
                    drop(store);
                    store = open(&disk, NEVER).unwrap();
                    assert_eq!(store.repaired(), 0);
                }
            }
            check_holds(&store, &map);
        }
    }
}

/// Returns the file of the open part with this ending.
fn part_file(disk: &MemoryDisk, ending: &str) -> std::path::PathBuf {
    let is_it = |path: &std::path::PathBuf| path.extension().is_some_and(|found| found == ending);
    disk.paths().into_iter().find(is_it).unwrap()
}

/// Wherever the end of the journal is torn off, the entries before are kept, and the later
/// artifacts are computed again.
#[test]
fn a_journal_torn_at_any_byte_keeps_the_entries_before() {
    let disk = empty_disk();
    let store = create(&disk, NEVER).unwrap();
    let keys: Vec<_> = (0..6).map(|item| key(1, 5 - item)).collect();
    for &key in &keys {
        store.put(key, &artifact(key)).unwrap();
    }
    drop(store);
    let path = part_file(&disk, "journal");
    let journal = disk.content(&path).unwrap();
    for cut in journal.len() - 3 * 32..=journal.len() {
        for garbage in [None, Some(0_u8), Some(0xA5)] {
            let torn = disk.after_kill();
            let mut bytes = journal[..cut].to_vec();
            let missing = journal.len() - cut;
            // The end is missing, or its space was already allocated, with other bytes in it.
            bytes.extend(garbage.iter().cycle().take(garbage.map_or(0, |_| missing)));
            torn.set_content(&path, &bytes);
            let whole = 6 - missing.div_ceil(32);
            let store = open(&torn, NEVER).unwrap();
            check_holds(&store, &all_of(keys[..whole].iter().copied()));
            for &key in &keys {
                store.put(key, &artifact(key)).unwrap();
            }
            drop(store);
            let store = open(&torn, NEVER).unwrap();
            assert_eq!(store.repaired(), 0);
            check_holds(&store, &all_of(keys.iter().copied()));
        }
    }
}

/// A damaged artifact is dropped, and so is everything that was stored after it: it may be the mark
/// which says that all artifacts are complete.
#[test]
fn what_was_put_after_a_damaged_artifact_is_dropped_with_it() {
    let disk = empty_disk();
    let store = create(&disk, NEVER).unwrap();
    let keys: Vec<_> = (0..9).map(|item| key(2, item)).collect();
    for &key in &keys {
        store.put(key, &artifact(key)).unwrap();
    }
    drop(store);
    let path = part_file(&disk, "data");
    let mut data = disk.content(&path).unwrap();
    let before: usize = keys[..4].iter().map(|&key| artifact(key).len()).sum();
    data[48 + before + 1] ^= 4;
    disk.set_content(&path, &data);
    let store = open(&disk, NEVER).unwrap();
    assert_eq!(store.repaired(), 5);
    check_holds(&store, &all_of(keys[..4].iter().copied()));
}

/// An intact entry in the position of another one is dropped, together with everything after it.
#[test]
fn an_entry_in_the_wrong_place_is_torn() {
    let disk = empty_disk();
    let store = create(&disk, NEVER).unwrap();
    let keys: Vec<_> = (0..6).map(|item| key(1, item)).collect();
    for &key in &keys {
        store.put(key, &artifact(key)).unwrap();
    }
    drop(store);
    let path = part_file(&disk, "journal");
    let mut journal = disk.content(&path).unwrap();
    journal.copy_within(48 + 4 * 32..48 + 5 * 32, 48 + 2 * 32);
    disk.set_content(&path, &journal);
    let store = open(&disk, NEVER).unwrap();
    assert_eq!(store.repaired(), 4);
    check_holds(&store, &all_of(keys[..2].iter().copied()));
}

/// A bit that flips while the store is open is detected when the artifact is read.
#[test]
fn reading_a_damaged_artifact_is_an_error() {
    let disk = empty_disk();
    let store = create(&disk, ALWAYS).unwrap();
    store.put(key(1, 1), b"heights").unwrap();
    let path = part_file(&disk, "data");
    let mut data = disk.content(&path).unwrap();
    *data.last_mut().unwrap() ^= 1;
    disk.set_content(&path, &data);
    let error = store.get(key(1, 1)).unwrap_err();
    check_damaged(&error, &path, "run the same command again (build: with --resume)");
}

/// Artifacts are only made durable at the requested interval; a loss of power costs no more than
/// that.
#[test]
fn the_interval_says_how_much_is_lost() {
    for (interval, expected) in [(ALWAYS, 10), (NEVER, 0), (Duration::from_hours(1), 0)] {
        let disk = empty_disk();
        let store = create(&disk, interval).unwrap();
        for item in 0..10 {
            store.put(key(1, item), &artifact(key(1, item))).unwrap();
        }
        // The process is dead before it can store the rest.
        disk.fail_after(0, DiskFailure::Death);
        drop(store);
        let store = open(&disk.after_kill(), NEVER).unwrap();
        assert_eq!(store.items(1).len(), expected);
    }
}

/// Threads that store, wait for each other and store again: artifacts that a thread has seen are in
/// the journal before those that it computed from them.
#[test]
fn a_later_put_of_any_thread_is_later_in_the_journal() {
    let disk = empty_disk();
    let store = create(&disk, NEVER).unwrap();
    let barrier = Barrier::new(4);
    thread::scope(|scope| {
        for thread in 0..4_u64 {
            let (store, barrier) = (&store, &barrier);
            scope.spawn(move || {
                for round in 0..30_u64 {
                    let key = key(1, round * 4 + thread);
                    store.put(key, &artifact(key)).unwrap();
                    if thread == round % 4 {
                        store.flush().unwrap();
                    }
                    barrier.wait();
                }
            });
        }
    });
    drop(store);
    let journal = disk.content(&part_file(&disk, "journal")).unwrap();
    let entries = journal[48..].chunks(32);
    let rounds: Vec<u64> =
        entries.map(|entry| u64::from_le_bytes(*entry.first_chunk().unwrap()) / 4).collect();
    assert_eq!(rounds.len(), 120);
    assert!(rounds.is_sorted());
    assert_eq!(check_all_right(&open(&disk, NEVER).unwrap()), 120);
}

/// A slow device holds up the thread that syncs, and no other thread.
#[test]
fn puts_and_gets_go_on_while_another_thread_syncs() {
    let disk = empty_disk();
    let store = create(&disk, ALWAYS).unwrap();
    disk.hold_syncs();
    thread::scope(|scope| {
        let syncing = scope.spawn(|| store.put(key(2, 0), &artifact(key(2, 0))));
        disk.wait_for_held_sync();
        let (done, wait) = mpsc::channel();
        let store = &store;
        scope.spawn(move || {
            for item in 0..100 {
                store.put(key(1, item), &artifact(key(1, item))).unwrap();
            }
            assert_eq!(check_all_right(store), 101);
            done.send(()).unwrap();
        });
        let in_time = wait.recv_timeout(Duration::from_mins(1));
        let is_syncing = !syncing.is_finished();
        disk.release_syncs();
        in_time.unwrap();
        assert!(is_syncing);
        syncing.join().unwrap().unwrap();
    });
    // Artifacts that were stored meanwhile are durable after the next sync.
    store.flush().unwrap();
    disk.fail_after(0, DiskFailure::Death);
    drop(store);
    assert_eq!(check_all_right(&open(&disk.after_kill(), NEVER).unwrap()), 101);
}

#[test]
fn a_store_of_another_plan_is_refused_and_stays_as_it_is() {
    let disk = empty_disk();
    drop(create(&disk, NEVER).unwrap());
    let error = LocalStore::open(disk.disk(), folder(), &[8; 32], NEVER).unwrap_err();
    assert!(matches!(error, StoreError::OtherPlan { .. }), "{error}");
    let error = create(&disk, NEVER).unwrap_err();
    assert!(matches!(error, StoreError::Exists { .. }), "{error}");
    assert_eq!(LocalStore::stored_plan(disk.disk(), folder()).unwrap(), Some(plan()));
    open(&disk, NEVER).unwrap();
}

#[test]
fn a_store_of_another_version_is_refused() {
    let disk = empty_disk();
    drop(create(&disk, NEVER).unwrap());
    let path = folder().join("store");
    let mut header = disk.content(&path).unwrap();
    header[8] += 1;
    disk.set_content(&path, &header);
    let error = open(&disk, NEVER).unwrap_err();
    assert!(error.is_unusable(), "{error}");
    let other = StoreError::OtherVersion { path: folder().into(), found: 2, known: 1 };
    // The error names the folder that can be deleted.
    assert_eq!(error.to_string(), other.to_string());
    let error = LocalStore::stored_plan(disk.disk(), folder()).unwrap_err();
    assert_eq!(error.to_string(), other.to_string());
    // The store can still be deleted.
    assert_eq!(LocalStore::discard(disk.disk(), folder()).unwrap(), NOTHING);
    assert_eq!(disk.paths(), NOTHING);
}

#[test]
fn a_header_or_a_plan_with_a_wrong_bit_is_refused() {
    for (name, at) in [("store", 0), ("store", 20), ("store", 46), ("store", 50), ("plan.json", 3)]
    {
        let disk = empty_disk();
        drop(create(&disk, NEVER).unwrap());
        let path = folder().join(name);
        let mut bytes = disk.content(&path).unwrap();
        bytes[at] ^= 0x10;
        disk.set_content(&path, &bytes);
        let error = LocalStore::stored_plan(disk.disk(), folder()).unwrap_err();
        check_damaged(&error, &path, "delete the store and start over (build: with -O)");
    }
}

/// The advice in the error about a damaged file helps.
#[test]
fn a_part_with_a_damaged_header_is_made_again_when_the_named_file_is_removed() {
    for file in ["journal", "data"] {
        let disk = empty_disk();
        let store = create(&disk, ALWAYS).unwrap();
        store.put(key(1, 1), &artifact(key(1, 1))).unwrap();
        drop(store);
        let path = part_file(&disk, file);
        let mut bytes = disk.content(&path).unwrap();
        bytes[3] ^= 0x10;
        disk.set_content(&path, &bytes);
        let error = open(&disk, NEVER).unwrap_err();
        check_damaged(&error, &path, "delete the file and run the same command again");
        disk.disk().remove(&path).unwrap();
        let store = open(&disk, NEVER).unwrap();
        check_holds(&store, &all_of([]));
        store.put(key(1, 1), &artifact(key(1, 1))).unwrap();
    }
}

/// Checks that an error about damage names the file and what to do.
fn check_damaged(error: &StoreError, path: &Path, remedy: &str) {
    assert!(matches!(error, StoreError::Damaged { path: found, .. } if found == path), "{error}");
    assert!(error.to_string().contains(remedy), "{error}");
}

#[test]
fn no_store_and_no_plan_where_there_is_nothing() {
    let disk = empty_disk();
    assert_eq!(LocalStore::stored_plan(disk.disk(), folder()).unwrap(), None);
    let error = open(&disk, NEVER).unwrap_err();
    assert!(matches!(error, StoreError::NoStore { .. }), "{error}");
}

#[test]
fn a_folder_with_something_else_is_no_store_and_stays_as_it_is() {
    let disk = empty_disk();
    for path in ["/data/notes/thesis.tex", "/data/mixed/lock", "/data/mixed/photo.jpg"] {
        let _ = disk.disk().create_folder(Path::new(path).parent().unwrap());
        disk.set_content(Path::new(path), b"mine");
    }
    let before = disk.paths();
    for folder in [Path::new("/data/notes"), Path::new("/data/mixed")] {
        let not_a_store = |error: &StoreError| matches!(error, StoreError::NotAStore { path, .. } if path == folder);
        let error = LocalStore::create(disk.disk(), folder, &plan(), NEVER).unwrap_err();
        assert!(not_a_store(&error), "{error}");
        assert!(not_a_store(&LocalStore::stored_plan(disk.disk(), folder).unwrap_err()));
        assert!(not_a_store(&LocalStore::discard(disk.disk(), folder).unwrap_err()));
        let (plan, interval) = (&plan(), NEVER);
        let own = corniche_store::OwnPart { folder, name: "roads", plan, interval };
        let error = open_parts(disk.disk(), &[], &plan.hash, Some(own)).unwrap_err();
        assert!(not_a_store(&error), "{error}");
    }
    assert_eq!(disk.paths(), before);
}

#[test]
fn of_two_builds_in_one_store_one_is_refused_with_the_name_of_the_other() {
    let disk = empty_disk();
    let first = create(&disk, NEVER).unwrap();
    first.put(key(1, 1), b"kept").unwrap();
    let error = open(&disk, NEVER).unwrap_err();
    let process = format!("process {} on ", std::process::id());
    assert!(
        matches!(&error, StoreError::Locked { owner, .. } if owner.starts_with(&process)),
        "{error}"
    );
    assert!(matches!(
        LocalStore::discard(disk.disk(), folder()).unwrap_err(),
        StoreError::Locked { .. }
    ));
    drop(first);
    assert_eq!(open(&disk, NEVER).unwrap().items(1), [1]);
}

#[test]
fn scratch_space_goes_when_it_is_dropped_or_its_owner_is_dead() {
    let disk = empty_disk();
    let store = create(&disk, NEVER).unwrap();
    let base = disk.paths().len();
    let scratch = store.scratch().unwrap();
    let other = store.scratch().unwrap();
    let spans: Vec<_> = (1..9_u8).map(|n| scratch.append(&[n; 100]).unwrap()).collect();
    for (span, n) in spans.iter().zip(1..) {
        assert_eq!(scratch.read(*span).unwrap(), [n; 100]);
    }
    assert_eq!(other.read(spans[0]).unwrap_err().kind(), std::io::ErrorKind::UnexpectedEof);
    assert_eq!(disk.paths().len(), base + 2);
    let killed = disk.after_kill();
    drop((scratch, other));
    assert_eq!(disk.paths().len(), base);

    let _store = open(&killed, NEVER).unwrap();
    assert_eq!(killed.paths().len(), base);
}

#[test]
fn removing_a_store_leaves_what_it_did_not_make() {
    let disk = empty_disk();
    let store = create(&disk, NEVER).unwrap();
    store.put(key(1, 1), b"heights").unwrap();
    let _ = store.scratch().unwrap();
    assert_eq!(store.remove().unwrap(), NOTHING);
    assert_eq!(disk.paths(), NOTHING);
    assert!(disk.disk().list(folder()).is_err());

    let store = create(&disk, NEVER).unwrap();
    let notes = folder().join("notes.txt");
    disk.set_content(&notes, b"mine");
    assert_eq!(store.remove().unwrap(), std::slice::from_ref(&notes));
    assert_eq!(disk.paths(), [notes]);
}

#[test]
fn a_store_that_was_removed_while_it_is_in_use_says_so() {
    let disk = empty_disk();
    let store = create(&disk, NEVER).unwrap();
    store.put(key(1, 1), b"heights").unwrap();
    for path in disk.paths() {
        disk.disk().remove(&path).unwrap();
    }
    disk.disk().remove_folder(folder()).unwrap();
    let error = store.flush().unwrap_err();
    assert!(matches!(error, StoreError::Gone { .. }), "{error}");
    let earlier = error.to_string();
    let error = store.put(key(1, 2), b"more").unwrap_err();
    assert!(matches!(&error, StoreError::Failed { cause, .. } if *cause == earlier), "{error}");
}

/// The same test on the file system of the machine, with properties that a test double does not
/// have: real locks, real identities.
#[test]
fn works_on_the_file_system_of_the_machine() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path().join("store");
    let plan = StoredPlan { hash: [1; 32], bytes: vec![b' '; 100_000] };
    let store = LocalStore::create(system(), &folder, &plan, NEVER).unwrap();
    let keys: Vec<_> = (0..500).map(|item| key((item % 3) as u8, item)).collect();
    for &key in &keys {
        store.put(key, &artifact(key)).unwrap();
    }
    check_holds(&store, &all_of(keys.iter().copied()));
    let error = LocalStore::open(system(), &folder, &plan.hash, NEVER).unwrap_err();
    assert!(matches!(error, StoreError::Locked { .. }), "{error}");
    drop(store);

    assert_eq!(LocalStore::stored_plan(system(), &folder).unwrap(), Some(plan.clone()));
    let store = LocalStore::open(system(), &folder, &plan.hash, NEVER).unwrap();
    check_holds(&store, &all_of(keys.iter().copied()));
    assert_eq!(store.repaired(), 0);
    let scratch = store.scratch().unwrap();
    let span = scratch.append(b"to be sorted").unwrap();
    assert_eq!(scratch.read(span).unwrap(), b"to be sorted");
    drop(scratch);

    store.put(key(5, 5), b"last").unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    let error = store.flush().unwrap_err();
    assert!(matches!(error, StoreError::Gone { .. }), "{error}");
}
