use corniche_geom::TILE_CELLS;

/// A plane through a piece of a road, and how far the ground beside it leaves that plane: true metres.
///
/// Of each pair the first is downwards, the second upwards; neither is below 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bed {
    /// Metres that the plane rises for each metre along the piece and for each metre to its left.
    pub slopes: [f32; 2],
    /// Metres that the ground leaves it for each metre away from the piece, up to [`Bed::reaches_m`]'s first.
    pub(crate) rises: [f32; 2],
    /// Metres that it leaves it at most within each of [`Bed::reaches_m`].
    pub(crate) most_m: [[f32; 2]; 3],
    /// Whether ground of other tiles may be within each of those.
    pub(crate) leaves_tile: [bool; 3],
}

impl Bed {
    /// How far from the piece each of the bounds holds, in a tile of this size whose roads are drawn so far to each side.
    pub(crate) fn reaches_m(tile_size_m: [f64; 2], width_margin_m: f64) -> [f64; 3] {
        let cell_m = NearHeights::reach_m(tile_size_m);
        [cell_m, 4.0 * cell_m, width_margin_m.max(8.0 * cell_m)]
    }
}

/// Heights of the ground no farther from a segment than [`NearHeights::reach_m`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NearHeights {
    /// Lowest and highest ground beneath, true metres above the reference point, rounded outwards.
    pub(crate) range_in_tile: [f32; 2],
    /// True metres that it may lie lower or higher for each metre away from the segment.
    pub(crate) rise: f32,
}

impl NearHeights {
    /// How far away they hold, in a tile of this size: the shorter side of one of its cells. Roads that look wider are drawn
    /// on a finer level, if there is one.
    pub(crate) fn reach_m([east_m, north_m]: [f64; 2]) -> f64 {
        east_m.min(north_m) / TILE_CELLS as f64
    }
}
