//! The tiles near a subtree are those within a ring of tiles around it.

use super::*;

fn tile(z: u8, x: u32, y: u32) -> TileId {
    TileId::new(z, x, y).unwrap()
}

#[test]
fn near_is_what_a_ring_of_tiles_reaches() {
    for scope in [tile(3, 2, 5), tile(0, 0, 0), tile(4, 15, 0), tile(2, 3, 3)] {
        for level in 0..=5_u8 {
            // The rule itself: the subtree's tiles or those above it, and their eight neighbours.
            let side = 1_u32 << level;
            let all = (0..side).flat_map(|x| (0..side).map(move |y| tile(level, x, y)));
            let is_own = |id: TileId| {
                let upper = level.min(scope.z());
                id.ancestor(upper) == scope.ancestor(upper)
            };
            for id in all {
                let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy)));
                let expected =
                    around.filter_map(|(dx, dy)| id.neighbour(dx, dy)).any(is_own) || is_own(id);
                assert_eq!(is_near(scope, id), expected, "{scope} {id}");
            }
        }
    }
}
