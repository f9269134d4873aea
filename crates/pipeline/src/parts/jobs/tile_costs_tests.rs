//! The cost of a subtree is the sum of its tiles' costs, and subtrees contain every tile once.

use proptest::prelude::*;

use super::*;

const LEVEL: u8 = 5;

fn tile(z: u8, x: u32, y: u32) -> TileId {
    TileId::new(z, x, y).unwrap()
}

/// Costs of some tiles of a small quadtree, finest and coarse ones.
fn some_costs() -> impl Strategy<Value = Vec<(TileId, u64)>> {
    let finest = (0_u32..32, 0_u32..32).prop_map(|(x, y)| tile(LEVEL, x, y));
    proptest::collection::vec((finest, 0_u8..=LEVEL, 0_u64..1_000_000), 1..200).prop_map(|costs| {
        // A coarse tile has finest tiles beneath it.
        let both =
            |(id, level, cost): (TileId, u8, u64)| [(id, cost), (id.ancestor(level), cost / 7)];
        costs.into_iter().flat_map(both).collect()
    })
}

proptest! {
    /// The cost of a subtree is the sum of its tiles' costs, added one by one.
    #[test]
    fn a_subtree_costs_what_its_tiles_cost(costs in some_costs()) {
        let all = TileCosts::new(LEVEL, costs.iter().copied());
        for id in costs.iter().flat_map(|&(id, _)| (0..=id.z()).map(move |level| id.ancestor(level))) {
            let beneath = |other: &&(TileId, u64)| {
                other.0.z() >= id.z() && other.0.ancestor(id.z()) == id
            };
            let sum: u64 = costs.iter().filter(beneath).map(|&(_, cost)| cost).sum();
            prop_assert_eq!(all.subtree_us(id), sum);
        }
        prop_assert_eq!(all.total_us(), costs.iter().map(|&(_, cost)| cost).sum::<u64>());
    }

    /// Each finest tile is in one subtree, no subtree is too large unless it is a single tile, and
    /// none could be merged with its siblings.
    #[test]
    fn subtrees_hold_every_tile_once_and_are_as_large_as_they_may(
        costs in some_costs(), most_us in 0_u64..10_000_000
    ) {
        let all = TileCosts::new(LEVEL, costs.iter().copied());
        let subtrees = all.split(most_us);
        let finest: BTreeSet<TileId> =
            costs.iter().map(|&(id, _)| id).filter(|id| id.z() == LEVEL).collect();
        for &id in &finest {
            let holding = subtrees.iter().filter(|subtree| {
                subtree.id == id.ancestor(subtree.id.z())
            });
            prop_assert_eq!(holding.count(), 1, "{}", id);
        }
        for subtree in &subtrees {
            prop_assert!(subtree.cost_us <= most_us || subtree.id.z() == LEVEL);
            prop_assert_eq!(subtree.cost_us, all.subtree_us(subtree.id));
            prop_assert!(finest.iter().any(|id| id.ancestor(subtree.id.z()) == subtree.id));
            if let Some(level) = subtree.id.z().checked_sub(1) {
                prop_assert!(all.subtree_us(subtree.id.ancestor(level)) > most_us);
            }
        }
        // Nothing is lost: tiles outside the subtrees are above them.
        let beneath: u64 = subtrees.iter().map(|subtree| subtree.cost_us).sum();
        prop_assert_eq!(beneath + all.above_us(&subtrees), all.total_us());
    }
}
