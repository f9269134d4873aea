//! Sequential reads become few requests, and many threads fetch a block only once.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::atomic::{AtomicU64, Ordering},
    thread,
    time::Duration,
};

use super::*;

const MANY: u64 = 1 << 20;
const FILE: u64 = 1;
const KEPT_BLOCKS: usize = 1024;
/// The limits for packages on web servers.
const WEB: CacheLimits =
    CacheLimits { block_bytes: 64 << 10, kept_bytes: 64 << 20, most_blocks: 64 };

fn of_the_web() -> BlockCache {
    BlockCache::new(WEB)
}

/// The content of a run: each block begins with its number.
fn content(run: &Range<u64>) -> Bytes {
    let blocks = run.clone().flat_map(|number| {
        let mut block = vec![0; WEB.block_bytes as usize];
        block[..8].copy_from_slice(&number.to_le_bytes());
        block
    });
    blocks.collect::<Vec<u8>>().into()
}

/// Reads blocks one after the other; returns the fetched runs.
fn fetched(blocks: &BlockCache, numbers: impl IntoIterator<Item = u64>) -> Vec<Range<u64>> {
    let mut runs = Vec::new();
    for number in numbers {
        let block = blocks.get((FILE, number), 1, MANY, |run| {
            runs.push(run.clone());
            Ok::<_, ()>(content(&run))
        });
        assert_eq!(block.unwrap()[..8], number.to_le_bytes());
    }
    runs
}

#[test]
fn reads_that_follow_each_other_become_few_requests() {
    let blocks = of_the_web();
    let runs = fetched(&blocks, 0..200);
    assert_eq!(runs, [0..1, 1..3, 3..7, 7..15, 15..31, 31..63, 63..127, 127..191, 191..255]);
    assert!(fetched(&blocks, 0..255).is_empty(), "they are kept");
}

#[test]
fn reads_here_and_there_take_what_they_ask_for() {
    let runs = fetched(&of_the_web(), [0, 900, 30, 800, 60, 700]);
    assert_eq!(runs, [0..1, 900..901, 30..31, 800..801, 60..61, 700..701]);
}

/// Threads that read in parallel, each in its own part.
#[test]
fn several_sequences_do_not_disturb_each_other() {
    let blocks = of_the_web();
    let both = (0..60).flat_map(|k| [k, 10_000 + k]);
    assert_eq!(fetched(&blocks, both).len(), 12, "six each");
}

#[test]
fn a_run_ends_before_what_is_there_and_at_the_end_of_the_file() {
    let blocks = of_the_web();
    fetched(&blocks, [12]);
    let run = |number, wanted, count| {
        let mut got = None;
        let block = blocks.get((FILE, number), wanted, count, |run| {
            got = Some(run.clone());
            Ok::<_, ()>(content(&run))
        });
        block.unwrap();
        got.unwrap()
    };
    assert_eq!(run(10, 6, MANY), 10..12);
    assert_eq!(run(50, 10, 55), 50..55);
    assert_eq!(run(100, 1000, MANY), 100..164);
}

#[test]
fn memory_is_bounded_and_the_blocks_used_last_stay() {
    let blocks = of_the_web();
    for number in 0..3 * KEPT_BLOCKS as u64 {
        fetched(&blocks, [5, 10 * number + 100]);
        assert!(blocks.state().blocks.len() <= KEPT_BLOCKS);
    }
    assert!(fetched(&blocks, [5]).is_empty(), "it is used again and again");
    assert_eq!(fetched(&blocks, [100]), std::slice::from_ref(&(100..101)), "it was used long ago");
}

#[test]
fn many_threads_fetch_a_block_once() {
    let blocks = of_the_web();
    let fetches = AtomicU64::new(0);
    thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                for number in 0..50 {
                    let block = blocks.get((FILE, number), 1, MANY, |run| {
                        fetches.fetch_add(run.end - run.start, Ordering::Relaxed);
                        thread::sleep(Duration::from_millis(1));
                        Ok::<_, ()>(content(&run))
                    });
                    assert_eq!(block.unwrap()[..8], number.to_le_bytes());
                }
            });
        }
    });
    assert_eq!(fetches.into_inner(), 63, "each block once, up to the end of a run");
}

/// A thread that waits for a fetch that fails then fetches the block itself.
#[test]
fn a_fetch_that_fails_or_panics_leaves_nobody_waiting() {
    let blocks = of_the_web();
    thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                let failed = blocks.get((FILE, 7), 1, MANY, |_| {
                    thread::sleep(Duration::from_millis(5));
                    Err::<Bytes, _>("broken")
                });
                assert_eq!(failed, Err("broken"));
            });
        }
    });
    let panics =
        || blocks.get((FILE, 7), 1, MANY, |_| -> Result<Bytes, ()> { panic!("on purpose") });
    assert!(catch_unwind(AssertUnwindSafe(panics)).is_err());
    assert_eq!(fetched(&blocks, [7]), std::slice::from_ref(&(7..8)));
}

#[test]
fn blocks_of_several_files_are_kept_within_the_limit() {
    let (size, limit_bytes) = (256 << 10, 4 << 20);
    let cache =
        BlockCache::new(CacheLimits { block_bytes: size, kept_bytes: limit_bytes, most_blocks: 1 });
    let block = |with: u8| Bytes::from(vec![with; size as usize]);
    for number in 0..100 {
        cache.get((1, number), 1, MANY, |_| Ok::<_, ()>(block(number as u8))).unwrap();
        // A block that is used again and again stays.
        let again = cache.get((1, 0), 1, MANY, |_| Err::<Bytes, _>(number)).unwrap();
        assert_eq!(again, vec![0; size as usize]);
        let state = cache.state();
        let bytes = state.blocks.values().map(|block| match block {
            BlockSlot::Kept { bytes, .. } => bytes.len() as u64,
            BlockSlot::Coming => 0,
        });
        let held: u64 = bytes.sum();
        assert_eq!(held, state.kept_bytes);
        assert!(held <= limit_bytes, "{held}");
    }
    assert!(cache.get((1, 99), 1, MANY, |_| Err::<Bytes, _>(())).is_ok(), "the last one is there");
    assert!(cache.get((1, 1), 1, MANY, |_| Err::<Bytes, _>(())).is_err(), "an old one is gone");
    assert!(
        cache.get((2, 99), 1, MANY, |_| Err::<Bytes, _>(())).is_err(),
        "another object is another block"
    );
}

/// Even if a block is larger than the cache limit, the last one is kept.
#[test]
fn what_was_fetched_last_is_kept_under_any_limit() {
    let cache = BlockCache::new(CacheLimits { block_bytes: 1000, kept_bytes: 10, most_blocks: 1 });
    for number in [3, 4] {
        cache.get((1, number), 1, MANY, |_| Ok::<_, ()>(Bytes::from(vec![0; 1000]))).unwrap();
        assert!(cache.get((1, number), 1, MANY, |_| Err::<Bytes, _>(())).is_ok());
        assert_eq!(cache.state().kept_bytes, 1000);
    }
}
