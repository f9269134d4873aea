//! The tree of intervals finds the same intervals as a scan of all of them.

use proptest::prelude::*;

use super::*;

proptest! {
    /// The tree finds the same intervals as a scan of all of them.
    #[test]
    fn finds_the_intervals_that_hold_a_number(
        intervals in prop::collection::vec([-20_i64..20, -20_i64..20], 0..60),
        number in -22_i64..22,
    ) {
        let tree = Stabbing::new(intervals.iter().copied());
        let mut found = Vec::new();
        tree.at(number, &mut |item| found.push(item));
        found.sort_unstable();
        let holds = |&item: &usize| intervals[item][0] <= number && number < intervals[item][1];
        let expected: Vec<usize> = (0..intervals.len()).filter(holds).collect();
        prop_assert_eq!(found, expected);
    }
}
