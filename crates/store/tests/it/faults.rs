//! Whatever fails and whenever: a clear error, and what is there afterwards is right.
//!
//! Source: the tests of `SQLite` that let the n-th call fail for n = 1, 2, 3 … until none fails, and that lose unsynced writes at a simulated
//! crash.
#![allow(clippy::unwrap_used, reason = "tests may unwrap")]

use std::{collections::BTreeSet, path::Path, time::Duration};

use crate::common::*;
use corniche_store::{Artifacts, Key, LocalStore, OwnPart, Scratch, StoreError};
use corniche_testing::{
    Random,
    disks::{Failure, MemoryDisk},
};

/// What a small build does with its store: puts of two kinds, a mark behind each group, some reading, scratch space. Goes on from what is
/// there, as a build does. `after` is told of each put that has returned and of each flush.
fn build(store: &LocalStore, after: &mut dyn FnMut(Done)) -> Result<(), StoreError> {
    for group in 0..6 {
        if store.has(mark(group)) {
            // The mark is put last: with it all of the group is there.
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
    Put(Key),
    Flush,
}

fn mark(group: u64) -> Key {
    key(5, group)
}

fn group_keys(group: u64) -> impl Iterator<Item = Key> {
    (0..5).map(move |n| key((n % 2) as u8, group * 5 + n))
}

const ALL: usize = 6 * 6;

/// The store's error in an error of its scratch space.
fn unwrapped(error: std::io::Error) -> StoreError {
    *error.into_inner().unwrap().downcast::<StoreError>().unwrap()
}

fn build_from_scratch(disk: &MemoryDisk, interval: Duration) -> Result<(), StoreError> {
    let store = create_or_open(disk, interval)?;
    build(&store, &mut |_| {})
}

/// The build ends after any failure: on this disk, and with nothing but what a build without failure leaves.
fn check_goes_on(disk: &MemoryDisk) {
    build_from_scratch(disk, NEVER).unwrap();
    let store = open(disk, NEVER).unwrap();
    assert_eq!(check_all_right(&store), ALL);
    assert_eq!(disk.paths().len(), 5, "{:?}", disk.paths());
    assert_eq!(store.remove().unwrap(), NOTHING);
    assert_eq!(disk.paths(), NOTHING);
}

/// Lets each call fail in turn until the build passes; returns how many calls there were.
fn every_call(failure: Failure, check: impl Fn(&MemoryDisk, Result<(), StoreError>)) -> u64 {
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
    let calls = every_call(Failure::Device, |disk, result| {
        // Only what is done when something is dropped can fail in silence: removing scratch space.
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
    let calls = every_call(Failure::Full, |disk, result| {
        let needs_no_room_any_more = result.is_ok();
        if let Err(error) = result {
            let text = error.to_string();
            assert!(text.contains("/data"), "{text}");
            assert!(
                text.contains("the disk is full; free space and run the same command"),
                "{text}"
            );
            // While it is full, going on fails in the same way, and harms nothing.
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
    for failure in [Failure::Interrupted, Failure::Short] {
        every_call(failure, |disk, result| {
            result.unwrap();
            check_goes_on(disk);
        });
    }
}

/// As by SIGKILL: the machine goes on.
#[test]
fn a_process_that_dies_at_any_call_can_be_gone_on_from() {
    every_call(Failure::Death, |disk, _| check_goes_on(&disk.after_kill()));
}

/// As by a loss of power, at any call, with 200 different losses and more: all that comes back is right, and what was made durable is there.
#[test]
fn a_crash_loses_what_was_not_made_durable_and_nothing_else() {
    let mut lost_some = 0;
    for seed in 0..600 {
        let mut random = Random::new(seed);
        let disk = empty_disk();
        disk.fail_after(random.below(320) as u64, Failure::Death);
        // Several crashes, one after the other, before the build may end.
        let mut durable = BTreeSet::new();
        let mut disk = disk;
        for _ in 0..3 {
            let mut put: BTreeSet<Key> = durable.clone();
            let store = create_or_open(&disk, NEVER);
            if let Ok(store) = &store {
                let _ = build(store, &mut |done| match done {
                    Done::Put(key) => drop(put.insert(key)),
                    Done::Flush => durable.clone_from(&put),
                });
            }
            // Nothing more reaches the disk, not even what is done when the store is dropped.
            disk.fail_after(0, Failure::Death);
            drop(store);
            disk = disk.after_crash(&mut random);
            if !durable.is_empty() {
                let store = open(&disk, NEVER).unwrap();
                let there = check_all_right(&store);
                assert!(durable.iter().all(|key| store.has(*key)), "seed {seed}");
                lost_some += usize::from(there < put.len());
            }
            disk.fail_after(random.below(200) as u64, Failure::Death);
        }
        check_goes_on(&disk.after_crash(&mut random));
    }
    assert!(lost_some > 100, "only {lost_some} crashes cost anything: the test does not see much");
}

/// What was cut off never comes back behind what is written in its place: a mark would stand for something lost.
#[test]
fn a_mark_that_was_cut_off_does_not_come_back_at_the_next_crash() {
    let damaged_disk = || {
        let disk = empty_disk();
        let store = create(&disk, NEVER).unwrap();
        for key in [key(1, 0), key(1, 1)] {
            store.put(key, &artifact(key)).unwrap();
        }
        // A mark may hold nothing, and then no checksum of its own can tell that it is an old one.
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
        // Long enough that the place of the mark lies within the file again.
        store.put(key(1, 7), &[7; 2000]).unwrap();
        disk.fail_after(random.below(9) as u64, Failure::Death);
        let _ = store.flush();
        disk.fail_after(0, Failure::Death);
        drop(store);
        let store = open(&disk.after_crash(&mut random), NEVER).unwrap();
        assert!(store.has(key(1, 0)) && !store.has(mark(0)), "seed {seed}");
        if let Some(bytes) = store.get(key(1, 7)).unwrap() {
            assert_eq!(bytes, [7; 2000]);
        }
    }
}

/// As above, with parts that are sealed: a part is there as a whole or not at all.
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
        disk.fail_after(random.below(330) as u64, Failure::Death);
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
        // Made again, it is the same part.
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
    for failure in [Failure::Device, Failure::Full, Failure::Death] {
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
            if failure == Failure::Death {
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

/// Each call fails in turn while a store is removed; then it can be removed again, or a new one be made.
#[test]
fn removing_that_fails_at_any_call_can_be_done_again() {
    for call in 0.. {
        let disk = empty_disk();
        build_from_scratch(&disk, NEVER).unwrap();
        let store = open(&disk, NEVER).unwrap();
        disk.fail_after(call, Failure::Device);
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

/// As by a loss of power at each call while a store is removed: what comes back is still known for ours, and a new store can be made there.
#[test]
fn a_crash_while_a_store_is_removed_leaves_nothing_that_nobody_knows() {
    for call in 0.. {
        let mut was_removed = false;
        for seed in 0..20 {
            let disk = empty_disk();
            build_from_scratch(&disk, NEVER).unwrap();
            let store = open(&disk, NEVER).unwrap();
            disk.fail_after(call, Failure::Death);
            let result = store.remove();
            was_removed = disk.is_failure_to_come();
            assert!(!was_removed || result.is_ok());
            disk.fail_after(0, Failure::Death);
            let disk = disk.after_crash(&mut Random::new(seed));
            build_from_scratch(&disk, NEVER)
                .unwrap_or_else(|error| panic!("call {call}, seed {seed}: {error}"));
        }
        if was_removed {
            return;
        }
    }
}

/// After a sync that failed nothing may be built on what was put: the system may have dropped it.
#[test]
fn nothing_is_kept_any_more_after_a_failed_sync() {
    let disk = empty_disk();
    let store = create(&disk, NEVER).unwrap();
    store.put(key(1, 1), &artifact(key(1, 1))).unwrap();
    // Four looks at names and files, then the data is synced.
    disk.fail_after(4, Failure::Device);
    let error = store.flush().unwrap_err();
    assert!(
        matches!(&error, StoreError::Io { doing: "make durable", path, .. } if path.extension().unwrap() == "data"),
        "{error}"
    );
    for error in [store.flush().unwrap_err(), store.put(key(1, 2), b"").unwrap_err()] {
        assert!(matches!(error, StoreError::Failed { .. }), "{error}");
    }
    drop(store);
    assert_eq!(open(&disk, NEVER).unwrap().items(1), NO_ITEMS);
}
