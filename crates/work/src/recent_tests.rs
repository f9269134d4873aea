//! The least recently used values are evicted first, and threads compute a value once.

use std::{
    convert::Infallible,
    sync::atomic::{AtomicUsize, Ordering},
    thread,
};

use super::*;

/// Requests a key whose value is ten times the key and takes this many bytes; returns whether the
/// value had to be computed.
fn ask(recent: &Recent<u32, u32>, key: u32, bytes: u64) -> bool {
    let mut was_made = false;
    let make = || {
        was_made = true;
        Ok::<_, Infallible>(10 * key)
    };
    let Ok(found) = recent.get(key, make, |_| bytes);
    assert_eq!(*found, 10 * key);
    was_made
}

#[test]
fn what_was_used_longest_ago_goes_first() {
    let recent = Recent::new(3 * (100 + ENTRY_BYTES));
    assert!([1, 2, 3].into_iter().all(|key| ask(&recent, key, 100)));
    assert!(!ask(&recent, 1, 100));
    assert!(ask(&recent, 4, 100));
    assert!(![1, 3, 4].into_iter().any(|key| ask(&recent, key, 100)));
    assert!(ask(&recent, 2, 100));
}

#[test]
fn what_is_larger_than_the_budget_is_kept_until_something_else_is_asked_for() {
    let recent = Recent::new(10);
    assert!(ask(&recent, 1, 1000));
    assert!(!ask(&recent, 1, 1000));
    assert!(ask(&recent, 2, 1000));
    assert!(ask(&recent, 1, 1000));
    assert_eq!(locked(&recent.kept).bytes, 1000 + ENTRY_BYTES);
}

#[test]
fn one_that_cannot_be_made_is_tried_again() {
    let recent = Recent::new(1000);
    assert_eq!(recent.get(1, || Err::<u32, _>("no"), |_| 0), Err("no"));
    assert!(ask(&recent, 1, 100));
}

#[test]
fn what_is_being_made_is_kept_while_others_are_made_for_it() {
    let recent = Recent::new(10);
    let make = || {
        for key in 1..5 {
            assert!(ask(&recent, key, 1000));
        }
        Ok::<_, Infallible>(0)
    };
    let Ok(made) = recent.get(0, make, |_| 1000);
    assert_eq!(*made, 0);
    assert!(!ask(&recent, 0, 1000));
    assert_eq!(locked(&recent.kept).bytes, 1000 + ENTRY_BYTES);
    assert_eq!(locked(&recent.kept).by_use.len(), 1);
}

#[test]
fn threads_make_a_thing_once() {
    let recent: Recent<u32, u32> = Recent::new(1 << 20);
    let made = AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for key in 0..100 {
                    let make = || {
                        made.fetch_add(1, Ordering::Relaxed);
                        Ok::<_, Infallible>(key)
                    };
                    let Ok(found) = recent.get(key, make, |_| 8);
                    assert_eq!(*found, key);
                }
            });
        }
    });
    assert_eq!(made.into_inner(), 100);
}
