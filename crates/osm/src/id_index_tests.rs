//! The index finds the same id as a plain search.

use proptest::prelude::*;

use super::*;

proptest! {
    #[test]
    fn an_id_is_found_where_a_plain_search_finds_it(
        near in prop::collection::btree_set(0_i64..3000, 0..400),
        far in prop::collection::btree_set(any::<i64>(), 0..40),
        others in prop::collection::vec(prop_oneof![-9_i64..3009, any::<i64>()], 0..200),
        after in 0..500_usize,
    ) {
        for set in [near.clone(), far.clone(), near.union(&far).copied().collect()] {
            let ids: Vec<i64> = set.into_iter().collect();
            let index = IdIndex::new(&ids);
            for &id in ids.iter().chain(&others).chain(&[i64::MIN, i64::MAX]) {
                prop_assert_eq!(index.find(id, after), ids.binary_search(&id).ok());
            }
        }
    }
}
