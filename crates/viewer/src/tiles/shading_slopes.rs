//! The slopes of a tile's ground as texels for shading.

use corniche_geom::{Cell, TILE_NODES};
use corniche_tileset::Relief;
use half::f16;
use serde::{Deserialize, Serialize};

use super::blocks;

/// The slopes of the ground at all nodes of a tile, as texels: rise in metres per metre east and
/// north, row 0 in the north.
///
/// The texels are slopes instead of normals, so that exaggeration needs only one product; both are
/// interpolated linearly between nodes. Half precision is exact to a 2048th of the slope.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ShadingSlopes {
    /// Bits of half-precision slopes.
    #[serde(with = "blocks::plain")]
    pub(crate) texels: Vec<[u16; 2]>,
    /// 255 where a node is water, else 0; empty without water.
    #[serde(with = "blocks::plain")]
    pub(crate) water: Vec<u8>,
}

/// Steeper slopes are clamped: half precision ends at 65504.
const STEEPEST: f64 = 32_768.0;

impl ShadingSlopes {
    /// Number of texels on a side.
    pub(crate) const SIDE: usize = TILE_NODES;

    /// The slopes of a relief with nodes at a distance of `cell`. Nodes without height are level;
    /// no pixel of the ground reads them.
    pub(crate) fn new(relief: &Relief, cell: Cell) -> Self {
        // Converted by way of f32, as some processors do anyway: otherwise slopes would be rounded
        // twice on these and once on others.
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
