//! The cache of blocks keeps its limit, and many threads fetch a block once.

use std::{
    sync::atomic::{AtomicU64, Ordering},
    thread,
    time::Duration,
};

use super::*;

fn block(bytes: u64, with: u8) -> Bytes {
    vec![with; bytes as usize].into()
}

#[test]
fn blocks_fit_the_memory() {
    for (limit, block) in [(1 << 20, 256 << 10), (16 << 20, 1 << 20), (1 << 30, 4 << 20)] {
        assert_eq!(BlockCache::new(limit).block_bytes(), block, "{limit}");
    }
}

#[test]
fn the_blocks_used_last_are_kept_within_the_limit() {
    let cache = BlockCache::new(4 << 20);
    let size = cache.block_bytes();
    for number in 0..100 {
        cache.get((1, number), || Ok::<_, ()>(block(size, number as u8))).unwrap();
        // One that is used again and again stays.
        let again = cache.get((1, 0), || Err::<Bytes, _>(number)).unwrap();
        assert_eq!(again, vec![0; size as usize]);
        let kept = cache.kept.lock().unwrap();
        let held: u64 = kept
            .blocks
            .values()
            .map(|(.., filling)| filling.lock().unwrap().as_ref().map_or(0, |b| b.len() as u64))
            .sum();
        assert_eq!(held, kept.bytes);
        assert!(held <= 4 << 20, "{held}");
    }
    assert!(cache.get((1, 99), || Err::<Bytes, _>(())).is_ok(), "the last one is there");
    assert!(cache.get((1, 1), || Err::<Bytes, _>(())).is_err(), "an old one is gone");
    assert!(cache.get((2, 99), || Err::<Bytes, _>(())).is_err(), "another object is another block");
}

#[test]
fn many_threads_fetch_a_block_once_and_a_failure_is_not_kept() {
    let cache = BlockCache::new(64 << 20);
    assert_eq!(cache.get((1, 7), || Err::<Bytes, _>("cut")), Err("cut"));
    let fetched = AtomicU64::new(0);
    thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                let bytes = cache.get((1, 7), || {
                    fetched.fetch_add(1, Ordering::Relaxed);
                    thread::sleep(Duration::from_millis(20));
                    Ok::<_, ()>(block(1000, 7))
                });
                assert_eq!(bytes.unwrap().len(), 1000);
            });
        }
    });
    assert_eq!(fetched.into_inner(), 1);
}
