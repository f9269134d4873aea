//! Whatever fails and whenever: the error is clear, and the content of the store is correct
//! afterwards.
//!
//! Source: the tests of `SQLite` that let the n-th call fail for n = 1, 2, 3 … until none fails,
//! and that lose unsynced writes in a simulated crash.
#![allow(clippy::unwrap_used, reason = "tests may unwrap")]

use std::{collections::BTreeSet, path::Path, time::Duration};

use crate::common::*;
use corniche_store::{ArtifactKey, Artifacts, LocalStore, OwnPart, ScratchSpace, StoreError};
use corniche_testing::{
    Random,
    disks::{DiskFailure, MemoryDisk},
};

/// Uses a store like a small build: stores artifacts of two kinds, a mark after each group, some
/// reading, scratch space. Resumes from the existing artifacts, like a build. `after` is called
/// after each stored artifact and after each flush.
fn build(store: &LocalStore, after: &mut dyn FnMut(Done)) -> Result<(), StoreError> {
    for group in 0..6 {
        if store.has(mark(group)) {
            // The mark is stored last: if it exists, all artifacts of the group exist.
            for key in group_keys(group) {
                assert_eq!(store.get(key)?, Some(artifact(key)), "{key:?} behind its mark");
            }
            continue;
        }
        let scratch = store.scratch()?;
        for key in group_keys(group) {
            store.put(key, &artifact(key))?;
            after(Done::Put(key));
            let span = scratch.append(&artifact(key)).map_err(unwrapped)?;
            assert_eq!(scratch.read(span).map_err(unwrapped)?, artifact(key));
            assert_eq!(store.get(key)?, Some(artifact(key)));
        }
        store.put(mark(group), &artifact(mark(group)))?;
        after(Done::Put(mark(group)));
        if group % 3 == 1 {
            store.flush()?;
            after(Done::Flush);
        }
    }
    store.flush()?;
    after(Done::Flush);
    Ok(())
}

enum Done {
    Put(ArtifactKey),
    Flush,
}

fn mark(group: u64) -> ArtifactKey {
    key(5, group)
}

fn group_keys(group: u64) -> impl Iterator<Item = ArtifactKey> {
    (0..5).map(move |n| key((n % 2) as u8, group * 5 + n))
}

const ALL: usize = 6 * 6;

/// Returns the store's error inside an error of its scratch space.
fn unwrapped(error: std::io::Error) -> StoreError {
    *error.into_inner().unwrap().downcast::<StoreError>().unwrap()
}

fn build_from_scratch(disk: &MemoryDisk, interval: Duration) -> Result<(), StoreError> {
    let store = create_or_open(disk, interval)?;
    build(&store, &mut |_| {})
}

/// Checks that the build can be completed on this disk after any failure, with the same files as a
/// build without failure.
fn check_goes_on(disk: &MemoryDisk) {
    build_from_scratch(disk, NEVER).unwrap();
    let store = open(disk, NEVER).unwrap();
    assert_eq!(check_all_right(&store), ALL);
    assert_eq!(disk.paths().len(), 5, "{:?}", disk.paths());
    assert_eq!(store.remove().unwrap(), NOTHING);
    assert_eq!(disk.paths(), NOTHING);
}

/// Lets each call fail in turn until the build succeeds; returns the number of calls.
fn every_call(failure: DiskFailure, check: impl Fn(&MemoryDisk, Result<(), StoreError>)) -> u64 {
    for call in 0.. {
        let disk = empty_disk();
        disk.fail_after(call, failure);
        let result = build_from_scratch(&disk, ALWAYS);
        if disk.is_failure_to_come() {
            result.unwrap();
            return call;
        }
        check(&disk, result);
    }
    unreachable!("the loop ends when nothing fails");
}

#[test]
fn a_device_that_fails_at_any_call_is_a_clear_error_and_the_build_goes_on_afterwards() {
    let calls = every_call(DiskFailure::Device, |disk, result| {
        // Only an operation during a drop can fail silently: deleting scratch space.
        if let Err(error) = result {
            let StoreError::Io { path, source, .. } = &error else { panic!("{error}") };
            assert!(path.starts_with("/data"), "{error}");
            assert_eq!(source.raw_os_error(), Some(5));
        }
        check_goes_on(disk);
    });
    assert!(calls > 200, "only {calls} calls");
}

#[test]
fn a_disk_that_is_full_at_any_call_says_so_and_the_build_goes_on_when_there_is_room() {
    let calls = every_call(DiskFailure::Full, |disk, result| {
        let needs_no_room_any_more = result.is_ok();
        if let Err(error) = result {
            let text = error.to_string();
            assert!(text.contains("/data"), "{text}");
            assert!(
                text.contains("the disk is full; free space and run the same command"),
                "{text}"
            );
            // While the disk is full, resuming fails in the same way, and does no harm.
            assert!(build_from_scratch(disk, ALWAYS).is_err());
        }
        disk.make_room();
        if needs_no_room_any_more {
            assert_eq!(check_all_right(&open(disk, NEVER).unwrap()), ALL);
        }
        check_goes_on(disk);
    });
    assert!(calls > 200, "only {calls} calls");
}

#[test]
fn an_interrupted_or_short_call_is_survived_without_a_trace() {
    for failure in [DiskFailure::Interrupted, DiskFailure::Short] {
        every_call(failure, |disk, result| {
            result.unwrap();
            check_goes_on(disk);
        });
    }
}

/// The process is killed at any call, and the machine continues.
#[test]
fn a_process_that_dies_at_any_call_can_be_gone_on_from() {
    every_call(DiskFailure::Death, |disk, _| check_goes_on(&disk.after_kill()));
}

/// Power is lost at any call, with 200 different losses and more: everything that reappears is
/// correct, and everything that was made durable exists.
#[test]
fn a_crash_loses_what_was_not_made_durable_and_nothing_else() {
    let mut lost_some = 0;
    for seed in 0..600 {
        let mut random = Random::new(seed);
        let disk = empty_disk();
        disk.fail_after(random.below(320) as u64, DiskFailure::Death);
        // Several crashes, one after another, before the build may complete.
        let mut durable = BTreeSet::new();
        let mut disk = disk;
        for _ in 0..3 {
            let mut put: BTreeSet<ArtifactKey> = durable.clone();
            let store = create_or_open(&disk, NEVER);
            if let Ok(store) = &store {
                let _ = build(store, &mut |done| match done {
                    Done::Put(key) => drop(put.insert(key)),
                    Done::Flush => durable.clone_from(&put),
                });
            }
            // Nothing more reaches the disk, not even operations when the store is dropped.
            disk.fail_after(0, DiskFailure::Death);
            drop(store);
            disk = disk.after_crash(&mut random);
            if !durable.is_empty() {
                let store = open(&disk, NEVER).unwrap();
                let there = check_all_right(&store);
                assert!(durable.iter().all(|key| store.has(*key)), "seed {seed}");
                lost_some += usize::from(there < put.len());
            }
            disk.fail_after(random.below(200) as u64, DiskFailure::Death);
        }
        check_goes_on(&disk.after_crash(&mut random));
    }
    assert!(lost_some > 100, "only {lost_some} crashes cost anything: the test does not see much");
}

/// Truncated entries never reappear after the new ones: a mark would then refer to lost artifacts.
#[test]
fn a_mark_that_was_cut_off_does_not_come_back_at_the_next_crash() {
    let damaged_disk = || {
        let disk = empty_disk();
        let store = create(&disk, NEVER).unwrap();
        for key in [key(1, 0), key(1, 1)] {
            store.put(key, &artifact(key)).unwrap();
        }
        // A mark may be empty, and then no checksum can tell that it is an old one.
        store.put(mark(0), b"").unwrap();
        drop(store);
        let is_data = |path: &std::path::PathBuf| path.extension().is_some_and(|e| e == "data");
        let path = disk.paths().into_iter().find(is_data).unwrap();
        let mut data = disk.content(&path).unwrap();
        data[48 + artifact(key(1, 0)).len()] ^= 1;
        disk.set_content(&path, &data);
        disk
    };
    for seed in 0..300 {
        let disk = damaged_disk();
        let mut random = Random::new(seed);
        let store = open(&disk, NEVER).unwrap();
        assert_eq!(store.repaired(), 2);
        // The artifact is long enough for the position of the mark to be within the file again.
        store.put(key(1, 7), &[7; 2000]).unwrap();
        disk.fail_after(random.below(9) as u64, DiskFailure::Death);
        let _ = store.flush();
        disk.fail_after(0, DiskFailure::Death);
        drop(store);
        let store = open(&disk.after_crash(&mut random), NEVER).unwrap();
        assert!(store.has(key(1, 0)) && !store.has(mark(0)), "seed {seed}");
        if let Some(bytes) = store.get(key(1, 7)).unwrap() {
            assert_eq!(bytes, [7; 2000]);
        }
    }
}

/// The same with parts that are sealed: a part exists as a whole or not at all.
#[test]
fn a_crash_while_a_part_is_sealed_leaves_a_whole_part_or_none() {
    let (mut whole, mut none) = (0, 0);
    for seed in 0..300 {
        let mut random = Random::new(seed);
        let disk = empty_disk();
        let make = |disk: &MemoryDisk| {
            let (plan, interval) = (&plan(), NEVER);
            let own = OwnPart { folder: folder(), name: "heights", plan, interval };
            let store = open_parts(disk.disk(), &[], &plan.hash, Some(own))?;
            build(&store, &mut |_| {})?;
            store.seal()
        };
        disk.fail_after(random.below(330) as u64, DiskFailure::Death);
        let result = make(&disk);
        let disk = disk.after_crash(&mut random);
        let read = open_parts(disk.disk(), &[folder()], &plan().hash, None);
        let there = match read {
            Ok(store) => check_all_right(&store),
            Err(StoreError::NoStore { .. }) => 0,
            Err(error) => panic!("seed {seed}: {error}"),
        };
        assert!(there == ALL || there == 0 && result.is_err(), "seed {seed}: {there}");
        whole += u32::from(there == ALL);
        none += u32::from(there == 0);
        // Written again, it is the same part.
        make(&disk).unwrap();
        let store = open_parts(disk.disk(), &[folder()], &plan().hash, None).unwrap();
        assert_eq!(check_all_right(&store), ALL);
        let parts =
            disk.paths().into_iter().filter(|path| path.starts_with(folder().join("parts")));
        assert_eq!(parts.count(), 1);
    }
    assert!(whole > 10 && none > 10, "{whole} whole, {none} none");
}

/// Each call fails in turn while a part is sealed.
#[test]
fn sealing_that_fails_at_any_call_can_be_done_again() {
    for failure in [DiskFailure::Device, DiskFailure::Full, DiskFailure::Death] {
        for call in 0.. {
            let mut disk = empty_disk();
            let (plan, interval) = (&plan(), NEVER);
            let own = OwnPart { folder: folder(), name: "heights", plan, interval };
            let open_part = |disk: &MemoryDisk| open_parts(disk.disk(), &[], &plan.hash, Some(own));
            let store = open_part(&disk).unwrap();
            build(&store, &mut |_| {}).unwrap();
            disk.fail_after(call, failure);
            let sealed = store.seal();
            if disk.is_failure_to_come() {
                sealed.unwrap().unwrap();
                assert!(call > 8, "only {call} calls");
                break;
            }
            disk.make_room();
            if failure == DiskFailure::Death {
                disk = disk.after_kill();
            }
            let store = open_part(&disk).unwrap();
            assert_eq!(check_all_right(&store), ALL);
            store.seal().unwrap();
            let parts = open_parts(disk.disk(), &[folder()], &plan.hash, None).unwrap();
            assert_eq!(check_all_right(&parts), ALL);
            let inside = |path: &Path| path.starts_with(folder().join("parts"));
            let (parts, rest): (Vec<_>, Vec<_>) =
                disk.paths().into_iter().partition(|path| inside(path));
            assert_eq!((parts.len(), rest.len()), (1, 3), "{failure:?} {call}: {rest:?}");
        }
    }
}

/// Each call fails in turn while a store is deleted; then it can be deleted again, or a new one can
/// be created.
#[test]
fn removing_that_fails_at_any_call_can_be_done_again() {
    for call in 0.. {
        let disk = empty_disk();
        build_from_scratch(&disk, NEVER).unwrap();
        let store = open(&disk, NEVER).unwrap();
        disk.fail_after(call, DiskFailure::Device);
        let result = store.remove();
        if disk.is_failure_to_come() {
            result.unwrap();
            return;
        }
        let again = disk.after_kill();
        LocalStore::discard(again.disk(), folder()).unwrap();
        assert_eq!(again.paths(), NOTHING);
        check_goes_on(&disk);
    }
}

/// Power is lost at each call while a store is deleted: the remaining files are still recognised,
/// and a new store can be created there.
#[test]
fn a_crash_while_a_store_is_removed_leaves_nothing_that_nobody_knows() {
    for call in 0.. {
        let mut was_removed = false;
        for seed in 0..20 {
            let disk = empty_disk();
            build_from_scratch(&disk, NEVER).unwrap();
            let store = open(&disk, NEVER).unwrap();
            disk.fail_after(call, DiskFailure::Death);
            let result = store.remove();
            was_removed = disk.is_failure_to_come();
            assert!(!was_removed || result.is_ok());
            disk.fail_after(0, DiskFailure::Death);
            let disk = disk.after_crash(&mut Random::new(seed));
            build_from_scratch(&disk, NEVER)
                .unwrap_or_else(|error| panic!("call {call}, seed {seed}: {error}"));
        }
        if was_removed {
            return;
        }
    }
}

/// After a failed sync nothing may rely on the stored artifacts: the system may have dropped them.
#[test]
fn nothing_is_kept_any_more_after_a_failed_sync() {
    let disk = empty_disk();
    let store = create(&disk, NEVER).unwrap();
    store.put(key(1, 1), &artifact(key(1, 1))).unwrap();
    // Four calls inspect names and files, then the data is synced.
    disk.fail_after(4, DiskFailure::Device);
    let error = store.flush().unwrap_err();
    assert!(
        matches!(&error, StoreError::Io { doing: "sync", path, .. } if path.extension().unwrap() == "data"),
        "{error}"
    );
    for error in [store.flush().unwrap_err(), store.put(key(1, 2), b"").unwrap_err()] {
        assert!(matches!(error, StoreError::Failed { .. }), "{error}");
    }
    drop(store);
    assert_eq!(open(&disk, NEVER).unwrap().items(1), NO_ITEMS);
}
