//! Sets are joined in any order, and the smallest number represents each of them.

use super::DisjointSets;

#[test]
fn a_set_is_known_by_its_smallest_number_in_whatever_order_it_was_joined() {
    for pairs in [[(1, 4), (4, 2), (6, 5)], [(2, 4), (5, 6), (4, 1)], [(4, 1), (6, 5), (1, 2)]] {
        let mut sets = DisjointSets::new(7);
        for (one, other) in pairs {
            sets.join(one, other);
        }
        let firsts: Vec<usize> = (0..7).map(|number| sets.first_of(number)).collect();
        assert_eq!(firsts, [0, 1, 1, 3, 1, 5, 5], "{pairs:?}");
        assert_eq!(sets.add(), 7);
        assert_eq!(sets.first_of(7), 7);
    }
}
