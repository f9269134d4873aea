//! Neighbouring ranges are fetched together, and distant ones separately.

use super::*;

#[test]
fn near_ranges_are_fetched_together_and_far_ones_apart() {
    let ranges = [[50_000, 100], [0, 100], [4_196, 10], [9_000, 5]];
    // There are 4096 bytes between the first two ranges, and 4794 between the next two.
    assert_eq!(merged_ranges(&ranges), [vec![1, 2], vec![3], vec![0]]);
    assert_eq!(merged_ranges(&[]), Vec::<Vec<usize>>::new());
}

#[test]
fn merged_ranges_stay_short_and_a_long_one_is_alone() {
    let ranges = [
        [0, MOST_MERGED_BYTES],
        [MOST_MERGED_BYTES, 1],
        [MOST_MERGED_BYTES + 1, MOST_MERGED_BYTES * 9],
    ];
    assert_eq!(merged_ranges(&ranges), [vec![0], vec![1], vec![2]]);
}

#[test]
fn the_same_range_twice_is_one_group_and_ends_of_numbers_do_no_harm() {
    assert_eq!(merged_ranges(&[[7, 5], [7, 5]]), [vec![0, 1]]);
    assert_eq!(merged_ranges(&[[u64::MAX - 1, 9], [u64::MAX, 9]]), [vec![0, 1]]);
}

#[test]
fn what_was_read_is_found_across_ranges_and_the_oldest_goes_first() {
    let mut cache = RangeCache::default();
    cache.put(0, [1, 2, 3].into());
    cache.put(3, [4, 5].into());
    assert_eq!(cache.get(1, 10), [2, 3, 4, 5]);
    assert_eq!(cache.get(1, 3), [2, 3, 4]);
    assert!(cache.get(7, 1).is_empty());
    cache.put(100, vec![0; CACHE_BYTES - 2].into());
    assert!(cache.get(0, 1).is_empty(), "used longest ago");
    assert_eq!(cache.get(3, 1), [4]);
}
