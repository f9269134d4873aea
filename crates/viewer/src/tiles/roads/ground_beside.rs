//! How far the ground next to a piece of a road is below or above it.

use corniche_geom::TILE_CELLS;

/// A plane through a piece of a road, and how far the ground next to it is below or above that
/// plane, true metres.
///
/// In each pair of bounds the first is for ground below, the second for ground above; neither is
/// negative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bed {
    /// Rise of the plane in metres per metre along the piece, and per metre to its left.
    pub slopes: [f32; 2],
    /// Maximum distance of the ground below or above the plane, in metres per metre away from the
    /// piece; applies within the first of [`Bed::reaches_m`].
    pub(crate) rises: [f32; 2],
    /// Maximum distance of the ground below or above the plane, in metres, within each of
    /// [`Bed::reaches_m`].
    pub(crate) most_m: [[f32; 2]; 3],
    /// Whether ground of other tiles may be within each of these distances.
    pub(crate) leaves_tile: [bool; 3],
}

impl Bed {
    /// The distances from the piece within which the bounds apply: one cell, four cells, and the
    /// width margin (at least eight cells).
    pub(crate) fn reaches_m(tile_size_m: [f64; 2], width_margin_m: f64) -> [f64; 3] {
        let cell_m = NearHeights::reach_m(tile_size_m);
        [cell_m, 4.0 * cell_m, width_margin_m.max(8.0 * cell_m)]
    }
}

/// Heights of the ground no farther from a segment than [`NearHeights::reach_m`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct NearHeights {
    /// Lowest and highest ground below, true metres above the reference point, rounded outwards.
    pub(crate) range_in_tile: [f32; 2],
    /// Maximum height difference of the ground, in true metres per metre away from the segment.
    pub(crate) rise: f32,
}

impl NearHeights {
    /// The distance within which these heights apply, in a tile of this size: the shorter side of
    /// one of its cells. If roads look wider than that, a finer level is drawn, if there is one.
    pub(crate) fn reach_m([east_m, north_m]: [f64; 2]) -> f64 {
        east_m.min(north_m) / TILE_CELLS as f64
    }
}
