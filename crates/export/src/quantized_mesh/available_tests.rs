//! Blocks of available tiles hold each tile once and nothing else.

use std::collections::BTreeSet;

use proptest::prelude::*;

use super::*;

fn tiles_of(levels: &[Vec<TileRectangle>], first: u8) -> BTreeSet<TerrainTile> {
    let mut found = BTreeSet::new();
    for (z, blocks) in (first..).zip(levels) {
        for TileRectangle { columns, rows } in blocks {
            for y in rows[0]..=rows[1] {
                for x in columns[0]..=columns[1] {
                    assert!(found.insert(TerrainTile { z, x, y }), "{z}/{x}/{y} is in two blocks");
                }
            }
        }
    }
    found
}

/// Returns tiles with all tiles above them.
fn with_ancestors(places: &[(u8, u32, u32)]) -> BTreeSet<TerrainTile> {
    let mut tiles = BTreeSet::new();
    for &(z, x, y) in places {
        let mut next = Some(TerrainTile { z, x: x % (2 << z), y: y % (1 << z) });
        while let Some(tile) = next {
            tiles.insert(tile);
            next = tile.parent();
        }
    }
    tiles
}

proptest! {
    /// Blocks hold the tiles, each once, and nothing else.
    #[test]
    fn blocks_are_the_tiles(places in prop::collection::vec((0_u8..6, 0_u32..64, 0_u32..32), 1..40)) {
        let tiles = with_ancestors(&places);
        prop_assert_eq!(tiles_of(&blocks(&tiles), 0), tiles);
    }

    /// The availability in a tile covers the tiles beneath it, down to the requested depth.
    #[test]
    fn beneath_is_what_lies_beneath(
        places in prop::collection::vec((0_u8..6, 0_u32..64, 0_u32..32), 1..40),
        depth in 1_u8..4,
    ) {
        let tiles = with_ancestors(&places);
        let levels = blocks(&tiles);
        for tile in &tiles {
            let is_beneath = |other: &&TerrainTile| {
                let Some(down) = other.z.checked_sub(tile.z) else { return false };
                (1..=depth).contains(&down) && [other.x >> down, other.y >> down] == [tile.x, tile.y]
            };
            let wanted: BTreeSet<TerrainTile> = tiles.iter().filter(is_beneath).copied().collect();
            let told = beneath(&levels, *tile, depth);
            prop_assert!(told.last().is_none_or(|last| !last.is_empty()));
            prop_assert_eq!(tiles_of(&told, tile.z + 1), wanted);
        }
    }
}

#[test]
fn a_rectangle_is_one_block() {
    let tiles = (2..=5).flat_map(|x| (1..=3).map(move |y| TerrainTile { z: 3, x, y })).collect();
    let levels = blocks(&tiles);
    assert_eq!(levels[3], [TileRectangle { columns: [2, 5], rows: [1, 3] }]);
    let json = to_json(&levels);
    assert_eq!(json[3], serde_json::json!([{ "startX": 2, "startY": 1, "endX": 5, "endY": 3 }]));
    assert_eq!(json[0], serde_json::json!([]));
}
