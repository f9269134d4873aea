//! The search for nodes finds the same nodes as a plain search.

use super::*;

#[test]
fn search_finds_what_plain_search_finds_in_any_order() {
    // A small linear congruential generator: no pattern that matters, and the same numbers every
    // time.
    let mut state = 1_u64;
    let mut next = |range: u64| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % range
    };
    for count in [0, 1, 2, 7, 100] {
        let mut ids: Vec<i64> = (0..count).map(|_| next(300) as i64 - 150).collect();
        ids.sort_unstable();
        ids.dedup();
        let mut search = IdSearch::new(&ids);
        let mut ascending: Vec<i64> = (0..400).map(|_| next(310) as i64 - 155).collect();
        let unordered = ascending.clone();
        ascending.sort_unstable();
        for id in ascending.into_iter().chain(unordered) {
            assert_eq!(search.find(id), ids.binary_search(&id).ok(), "{id} in {ids:?}");
        }
    }
}
