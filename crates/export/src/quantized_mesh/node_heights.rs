//! Heights at the nodes of coarse levels, at which all tiles look where their own ground ends.

use corniche_work::Recent;

use super::tiling::Nodes;
use crate::error::QuantizedMeshError;

/// Nodes along each side of a block, which is sampled at once.
const BLOCK: i64 = 16;
/// What is kept of the blocks, about: the many tiles along the end of the ground look at the same few of them.
const KEPT_BYTES: u64 = 4 << 20;

/// A block of nodes: their level, how many there are along a tile, and the block's column and row.
type Key = (u8, i64, [i64; 2]);

/// The heights that were looked at last. Without them each tile would look for tiles of the package all over it, for a few places in each.
pub(crate) struct NodeHeights(Recent<Key, Vec<f64>>);

impl NodeHeights {
    pub(crate) fn new() -> Self {
        Self(Recent::new(KEPT_BYTES))
    }

    /// Heights at the nodes of a rectangle, given by its south-western and north-eastern node, row by row from the south. `sample` tells those at longitudes
    /// and latitudes, the same for a place each time.
    ///
    /// # Errors
    /// Those of `sample`.
    pub(crate) fn of_nodes(
        &self,
        nodes: Nodes,
        [west, south]: [i64; 2],
        [east, north]: [i64; 2],
        sample: impl Fn(&[[f64; 2]]) -> Result<Vec<f64>, QuantizedMeshError>,
    ) -> Result<Vec<f64>, QuantizedMeshError> {
        let columns = (east - west + 1) as usize;
        let mut heights_m = vec![f64::NAN; columns * (north - south + 1) as usize];
        let blocks = |first: i64, last: i64| first.div_euclid(BLOCK)..=last.div_euclid(BLOCK);
        for block_row in blocks(south, north) {
            for block_column in blocks(west, east) {
                let corner = [block_column * BLOCK, block_row * BLOCK];
                let key = (nodes.level, nodes.per_tile, [block_column, block_row]);
                let end = corner.map(|index| index + BLOCK - 1);
                let make = || sample(&nodes.places_deg(corner, end));
                let block = self.0.get(key, make, |block| size_of_val(&block[..]) as u64)?;
                let [i0, j0] = corner;
                for j in south.max(j0)..=north.min(j0 + BLOCK - 1) {
                    let [first, last] = [west.max(i0), east.min(i0 + BLOCK - 1)];
                    let (from, count) =
                        ((j - j0) * BLOCK + first - i0, (last - first + 1) as usize);
                    let into = (j - south) as usize * columns + (first - west) as usize;
                    heights_m[into..into + count]
                        .copy_from_slice(&block[from as usize..from as usize + count]);
                }
            }
        }
        Ok(heights_m)
    }
}

#[cfg(test)]
#[path = "node_heights_tests.rs"]
mod tests;
