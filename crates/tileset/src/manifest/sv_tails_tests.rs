//! Tests of the list of tiles with many SV roads.

use corniche_geom::TileId;
use proptest::prelude::*;

use super::{LEAST_TAIL_BYTES, MOST_TAILS, SvTail, SvTails};

fn tile(number: u32) -> TileId {
    TileId::new(9, number % 512, number / 512).unwrap()
}

#[test]
fn a_tail_is_written_as_four_numbers_and_read_again() {
    let tail = SvTail { tile: TileId::new(3, 2, 5).unwrap(), bytes: 179_496 };
    let json = serde_json::to_string(&tail).unwrap();
    assert_eq!(json, "[3,2,5,179496]");
    assert_eq!(serde_json::from_str::<SvTail>(&json).unwrap(), tail);
    // Not a tile: a column beyond its level, and a level that does not fit in a byte.
    for wrong in ["[3,8,0,5000]", "[256,0,0,5000]", "[300,0,0,5000]", "[3,2,5,-1]"] {
        serde_json::from_str::<SvTail>(wrong).unwrap_err();
    }
}

#[test]
fn few_bytes_are_not_listed() {
    let mut tails = SvTails::new();
    tails.add(tile(0), 0);
    tails.add(tile(1), u64::from(LEAST_TAIL_BYTES) - 1);
    tails.add(tile(2), u64::from(LEAST_TAIL_BYTES));
    tails.add(tile(3), u64::from(u32::MAX) + 1);
    assert_eq!(tails.list(), [SvTail { tile: tile(2), bytes: LEAST_TAIL_BYTES }]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// The list contains all tiles, sorted by bytes and then by position, and capped. The test
    /// computes it in another way, with tiles in any order.
    #[test]
    fn the_largest_are_listed_in_the_order_of_tiles(
        sizes in prop::collection::vec(4000_u64..4200, 0..2500),
        turn in 0_usize..2500,
    ) {
        let mut all: Vec<(u64, u32)> = (0..).zip(&sizes).map(|(n, &bytes)| (bytes, n)).collect();
        let order = |n: u32| crate::pmtiles_order(tile(n));
        let mut tails = SvTails::new();
        let start = turn.min(all.len());
        for &(bytes, n) in all[start..].iter().chain(&all[..start]) {
            tails.add(tile(n), bytes);
        }
        all.retain(|(bytes, _)| *bytes >= u64::from(LEAST_TAIL_BYTES));
        all.sort_by(|a, b| b.0.cmp(&a.0).then(order(a.1).cmp(&order(b.1))));
        all.truncate(MOST_TAILS);
        all.sort_by_key(|&(_, n)| order(n));
        let wanted: Vec<SvTail> =
            all.iter().map(|&(bytes, n)| SvTail { tile: tile(n), bytes: bytes as u32 }).collect();
        prop_assert_eq!(tails.list(), wanted);
    }
}
