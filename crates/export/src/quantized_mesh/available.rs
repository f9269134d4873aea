//! The availability of tiles, in the form of layer.json.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use super::tiling::TerrainTile;

/// The first and the last column, and the first and the last row, both included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TileRectangle {
    columns: [u32; 2],
    rows: [u32; 2],
}

/// Groups the tiles of each level up to the finest into rectangles, each tile in exactly one.
pub(crate) fn blocks(tiles: &BTreeSet<TerrainTile>) -> Vec<Vec<TileRectangle>> {
    let finest = tiles.iter().map(|tile| tile.z).max().unwrap_or(0);
    (0..=finest).map(|level| blocks_of_level(tiles, level)).collect()
}

fn blocks_of_level(tiles: &BTreeSet<TerrainTile>, level: u8) -> Vec<TileRectangle> {
    let mut rows: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for tile in tiles.iter().filter(|tile| tile.z == level) {
        rows.entry(tile.y).or_default().push(tile.x);
    }
    let mut done: Vec<TileRectangle> = Vec::new();
    // Blocks that end in the previous row.
    let mut open: Vec<TileRectangle> = Vec::new();
    for (row, columns) in rows {
        let mut next = Vec::new();
        for run in columns.chunk_by(|one, other| one + 1 == *other) {
            let columns = [run[0], run[run.len() - 1]];
            let above =
                |block: &TileRectangle| block.columns == columns && block.rows[1] + 1 == row;
            next.push(match open.iter().position(above) {
                Some(place) => {
                    let block = open.swap_remove(place);
                    TileRectangle { rows: [block.rows[0], row], ..block }
                }
                None => TileRectangle { columns, rows: [row, row] },
            });
        }
        done.append(&mut open);
        open = next;
    }
    done.append(&mut open);
    done.sort_unstable_by_key(|block| (block.rows, block.columns));
    done
}

/// Returns the parts of the blocks in the tile's rectangle, for up to `depth` levels beneath it,
/// without empty levels at the end.
pub(crate) fn beneath(
    levels: &[Vec<TileRectangle>],
    tile: TerrainTile,
    depth: u8,
) -> Vec<Vec<TileRectangle>> {
    let mut found: Vec<Vec<TileRectangle>> = (1..=depth)
        .map_while(|down| {
            let blocks = levels.get(usize::from(tile.z + down))?;
            let inside = |index: u32| [index << down, ((index + 1) << down) - 1];
            let [columns, rows] = [tile.x, tile.y].map(inside);
            let cut = |block: &TileRectangle| {
                let both = |[from, to]: [u32; 2], [first, last]: [u32; 2]| {
                    let [from, to] = [from.max(first), to.min(last)];
                    (from <= to).then_some([from, to])
                };
                Some(TileRectangle {
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

/// Returns the blocks in the form of layer.json: rows count from the south, whatever its `scheme`.
pub(crate) fn to_json(levels: &[Vec<TileRectangle>]) -> Value {
    let block = |block: &TileRectangle| {
        let TileRectangle { columns, rows } = block;
        json!({ "startX": columns[0], "startY": rows[0], "endX": columns[1], "endY": rows[1] })
    };
    levels.iter().map(|blocks| blocks.iter().map(block).collect::<Value>()).collect()
}

#[cfg(test)]
#[path = "available_tests.rs"]
mod tests;
