//! Counting short numbers at once gives the same count as reading each of them.

use corniche_testing::pbf::varint;
use proptest::prelude::*;

use super::*;
use crate::wire::PackedNumbers;

proptest! {
    /// The count at once equals the count one by one, and no long or truncated number counts as
    /// short.
    #[test]
    fn short_numbers_are_those_that_are_read(
        numbers in prop::collection::vec((any::<u64>(), 20..64_u32), 0..200),
        cut in 0..3_usize,
    ) {
        let numbers: Vec<u64> = numbers.into_iter().map(|(number, shift)| number >> shift).collect();
        let mut bytes = numbers.iter().flat_map(|&number| varint(number)).collect::<Vec<u8>>();
        bytes.truncate(bytes.len().saturating_sub(cut));
        let read: Result<Vec<u64>, _> = PackedNumbers::from_packed(&bytes).collect();
        let is_short = |read: &Vec<u64>| read.iter().all(|&number| number < SHORT_LIMIT);
        let expected = read.ok().filter(is_short).map(|read| read.len() as u64);
        let expected = expected.filter(|_| bytes.len() >= WORTHWHILE_BYTES);
        prop_assert_eq!(count_short(&bytes), expected);
    }
}

#[test]
fn a_long_number_is_seen_wherever_it_stands() {
    for at in 0..100 {
        for (number, is_short) in [(SHORT_LIMIT - 1, true), (SHORT_LIMIT, false)] {
            let bytes = [vec![7; at], varint(number), vec![7; 100 - at]].concat();
            assert_eq!(count_short(&bytes), is_short.then_some(101), "{number} at {at}");
        }
    }
}
