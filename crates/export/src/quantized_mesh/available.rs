//! Which tiles there are, as layer.json tells it.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use super::tiling::TerrainTile;

/// Columns from … to, in rows from … to, both included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Block {
    columns: [u32; 2],
    rows: [u32; 2],
}

/// The tiles of each level up to the finest in rectangles, each tile in one of them.
pub(crate) fn blocks(tiles: &BTreeSet<TerrainTile>) -> Vec<Vec<Block>> {
    let finest = tiles.iter().map(|tile| tile.z).max().unwrap_or(0);
    (0..=finest).map(|level| blocks_of_level(tiles, level)).collect()
}

fn blocks_of_level(tiles: &BTreeSet<TerrainTile>, level: u8) -> Vec<Block> {
    let mut rows: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for tile in tiles.iter().filter(|tile| tile.z == level) {
        rows.entry(tile.y).or_default().push(tile.x);
    }
    let mut done: Vec<Block> = Vec::new();
    // Blocks that end in the row before.
    let mut open: Vec<Block> = Vec::new();
    for (row, columns) in rows {
        let mut next = Vec::new();
        for run in columns.chunk_by(|one, other| one + 1 == *other) {
            let columns = [run[0], run[run.len() - 1]];
            let above = |block: &Block| block.columns == columns && block.rows[1] + 1 == row;
            next.push(match open.iter().position(above) {
                Some(place) => {
                    let block = open.swap_remove(place);
                    Block { rows: [block.rows[0], row], ..block }
                }
                None => Block { columns, rows: [row, row] },
            });
        }
        done.append(&mut open);
        open = next;
    }
    done.append(&mut open);
    done.sort_unstable_by_key(|block| (block.rows, block.columns));
    done
}

/// What of the blocks lies in the tile's rectangle, on the levels beneath it up to `depth` of them; none at the end.
pub(crate) fn beneath(levels: &[Vec<Block>], tile: TerrainTile, depth: u8) -> Vec<Vec<Block>> {
    let mut found: Vec<Vec<Block>> = (1..=depth)
        .map_while(|down| {
            let blocks = levels.get(usize::from(tile.z + down))?;
            let inside = |index: u32| [index << down, ((index + 1) << down) - 1];
            let [columns, rows] = [tile.x, tile.y].map(inside);
            let cut = |block: &Block| {
                let both = |[from, to]: [u32; 2], [first, last]: [u32; 2]| {
                    let [from, to] = [from.max(first), to.min(last)];
                    (from <= to).then_some([from, to])
                };
                Some(Block {
                    columns: both(block.columns, columns)?,
                    rows: both(block.rows, rows)?,
                })
            };
            Some(blocks.iter().filter_map(cut).collect())
        })
        .collect();
    while found.last().is_some_and(Vec::is_empty) {
        found.pop();
    }
    found
}

/// The blocks as layer.json has them: rows count from the south, whatever its `scheme`.
pub(crate) fn to_json(levels: &[Vec<Block>]) -> Value {
    let block = |block: &Block| {
        let Block { columns, rows } = block;
        json!({ "startX": columns[0], "startY": rows[0], "endX": columns[1], "endY": rows[1] })
    };
    levels.iter().map(|blocks| blocks.iter().map(block).collect::<Value>()).collect()
}

#[cfg(test)]
#[path = "available_tests.rs"]
mod tests;
