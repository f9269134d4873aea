use super::*;

#[test]
fn rounds_to_the_resolution_of_the_data_and_marks_what_is_not_on_earth() {
    assert_eq!(location_from_nano(9_500_000_049, -47_000_000_050), [95_000_000, -470_000_000]);
    assert_eq!(location_from_nano(9_500_000_050, -47_000_000_051), [95_000_001, -470_000_001]);
    assert_eq!(location_from_nano(180_000_000_000, -90_000_000_000), [1_800_000_000, -900_000_000]);
    assert_eq!(location_from_nano(180_000_000_001, 0), OUT_OF_RANGE);
    assert_eq!(location_from_nano(0, 90_000_000_001), OUT_OF_RANGE);
    assert_eq!(location_from_nano(i64::MIN, i64::MAX), OUT_OF_RANGE);
    assert_eq!(location_from_nano(214_748_364_700, 214_748_364_700), MISSING);
    assert_eq!(location_from_nano(214_748_364_700, 0), OUT_OF_RANGE);
    assert_eq!(degrees([95_000_001, -470_000_000]), Some([9.500_000_1, -47.0]));
    assert_eq!((degrees(MISSING), degrees(OUT_OF_RANGE)), (None, None));
}

#[test]
fn search_finds_what_plain_search_finds_in_any_order() {
    // A small linear congruential generator: no pattern that matters, the same every time.
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
        let mut search = Search { ids: &ids, at: 0 };
        let mut ascending: Vec<i64> = (0..400).map(|_| next(310) as i64 - 155).collect();
        let unordered = ascending.clone();
        ascending.sort_unstable();
        for id in ascending.into_iter().chain(unordered) {
            assert_eq!(search.find(id), ids.binary_search(&id).ok(), "{id} in {ids:?}");
        }
    }
}
