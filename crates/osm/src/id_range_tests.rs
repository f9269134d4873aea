//! The range of node ids in a block covers dense and plain nodes together.

use corniche_testing::pbf::BlockBuilder;
use proptest::prelude::*;

use super::*;

proptest! {
    #[test]
    fn the_range_is_that_of_dense_and_plain_nodes_together(
        dense in prop::collection::vec(-50_i64..50, 0..9),
        plain in prop::collection::vec(prop_oneof![-60_i64..60, Just(i64::MIN), Just(i64::MAX)], 0..5),
    ) {
        let nodes = |ids: &[i64]| ids.iter().map(|&id| (id, 0, 0)).collect::<Vec<_>>();
        let mut block = BlockBuilder::new();
        block.dense(&nodes(&dense));
        block.plain(&nodes(&plain));
        // Ids of ways do not count.
        block.track(1000, &[-1000, 1000]);
        let all = || dense.iter().chain(&plain).copied();
        let expected = all().min().zip(all().max()).map(|(least, most)| IdRange { least, most });
        prop_assert_eq!(IdRange::scan(&crate::block::AuditedBlock::new(&block.bytes())), expected);
    }

    #[test]
    fn ranges_meet_where_an_id_lies_in_both(a in 0_i64..9, b in 0_i64..9, c in 0_i64..9, d in 0_i64..9) {
        let range = |a: i64, b: i64| IdRange { least: a.min(b), most: a.max(b) };
        let (one, other) = (range(a, b), range(c, d));
        let lies_in = |id: i64, range: IdRange| (range.least..=range.most).contains(&id);
        let expected = (0..9).any(|id| lies_in(id, one) && lies_in(id, other));
        prop_assert_eq!(one.meets(other), expected);
        prop_assert_eq!(other.meets(one), expected);
    }
}
