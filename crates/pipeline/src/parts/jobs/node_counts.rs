//! How many nodes of each finest tile lie in the rectangles of files.

use corniche_geom::{GridFrame, NodeIndex, TILE_CELLS, TileId};
use corniche_spec::data_tiles::DataTiles;

/// Nodes of a tile that belong to it.
const TILE_NODES: u64 = (TILE_CELLS * TILE_CELLS) as u64;

/// All tiles of `data`, row by row, each with the number of its nodes in the rectangles, which are given by their south-western and
/// north-eastern node. Where rectangles overlap, nodes count twice, but no tile has more than all its nodes.
pub(crate) fn nodes_by_tile(
    frame: &GridFrame,
    data: &DataTiles,
    rectangles: &[[NodeIndex; 2]],
) -> Vec<(TileId, u64)> {
    let tiles = data.within(TileId::ROOT);
    let (Some(&first), Some(&last)) = (tiles.first(), tiles.last()) else { return Vec::new() };
    let columns = (last.x() - first.x() + 1) as usize;
    let mut counted: Vec<(TileId, u64)> = tiles.into_iter().map(|id| (id, 0)).collect();
    let corner = frame.root_corner();
    for [south_west, north_east] in rectangles {
        // Rows count from the north, nodes from the south.
        let across =
            overlaps([south_west.i - corner.i, north_east.i - corner.i], [first.x(), last.x()]);
        let down =
            overlaps([corner.j - north_east.j, corner.j - south_west.j], [first.y(), last.y()]);
        for &(y, rows) in &down {
            for &(x, nodes) in &across {
                let index = (y - first.y()) as usize * columns + (x - first.x()) as usize;
                let count = &mut counted[index].1;
                *count = (*count + rows * nodes).min(TILE_NODES);
            }
        }
    }
    counted
}

/// How many of the nodes from `low` to `high` along an axis belong to each tile from `first` to `last`, where it is any.
fn overlaps([low, high]: [i64; 2], [first, last]: [u32; 2]) -> Vec<(u32, u64)> {
    let tile_of = |node: i64| node.div_euclid(TILE_CELLS);
    let from = tile_of(low).max(i64::from(first));
    // The last tile has the nodes on the border behind it, too.
    let to = tile_of(high).min(i64::from(last));
    (from..=to)
        .map(|tile| {
            let begin = low.max(tile * TILE_CELLS);
            let end = high.min((tile + 1) * TILE_CELLS - 1);
            (tile as u32, (end - begin + 1).max(0) as u64)
        })
        .collect()
}

#[cfg(test)]
#[path = "node_counts_tests.rs"]
mod tests;
