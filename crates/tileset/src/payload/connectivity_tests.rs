//! Exactly the edges that were added are found.

use std::collections::BTreeSet;

use proptest::prelude::*;

use super::*;

proptest! {
    /// Exactly the edges that were added are found, in any order of additions.
    #[test]
    fn edges_are_what_was_added(triangles in prop::collection::vec([0..40_u32, 0..40, 0..40], 0..300)) {
        let work = StepBudget::new(u64::MAX);
        let (mut edges, mut expected) = (Edges::new(40, triangles.len(), &work), BTreeSet::new());
        for [a, b, c] in triangles {
            let sides = [[a, b], [b, c], [c, a]];
            if a == b || b == c || c == a || sides.iter().any(|side| expected.contains(side)) {
                continue;
            }
            prop_assert!(edges.add([a, b, c]).is_ok());
            expected.extend(sides);
        }
        for (a, b) in (0..40).flat_map(|a| (0..40).map(move |b| (a, b))) {
            prop_assert_eq!(edges.has(a, b), expected.contains(&[a, b]));
        }
    }
}
