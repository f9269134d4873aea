//! The slopes of a tile's ground as texels for shading.

use corniche_geom::{Cell, TILE_NODES};
use corniche_tileset::Relief;
use half::f16;
use serde::{Deserialize, Serialize};

use super::blocks;

/// The slopes of the ground at all nodes of a tile, as texels: rise in metres per metre east and north, row 0 in the north.
///
/// Slopes and not normals, so that a stretched ground needs one product; both are mixed along a straight line between nodes. Half
/// precision is exact to a 2048th of the slope.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ShadingSlopes {
    /// Bits of half-precision numbers.
    #[serde(with = "blocks::plain")]
    pub(crate) texels: Vec<[u16; 2]>,
    /// 255 where a node is water, else 0; empty without water.
    #[serde(with = "blocks::plain")]
    pub(crate) water: Vec<u8>,
}

/// Steeper slopes are cut: half precision ends at 65504.
const STEEPEST: f64 = 32_768.0;

impl ShadingSlopes {
    /// Texels on a side.
    pub(crate) const SIDE: usize = TILE_NODES;

    /// The slopes of a relief whose nodes are a `cell` apart. Nodes without height are level; no pixel of the ground reads them.
    pub(crate) fn new(relief: &Relief, cell: Cell) -> Self {
        // By way of f32, as some processors do it anyway: else it would be rounded twice on these and once on others.
        let half = |slope: f64| f16::from_f32(slope.clamp(-STEEPEST, STEEPEST) as f32).to_bits();
        let texels = relief.slopes(cell).map(|slopes| slopes.map(half)).collect();
        let water = relief.water().unwrap_or_default();
        Self {
            texels,
            water: water.iter().map(|&is_water| if is_water { 255 } else { 0 }).collect(),
        }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "shading_slopes_tests.rs"]
mod tests;
