//! What the splitting of areas and that of lines by tile have in common: the tiles that are wanted, and the lattice of each level.

use corniche_geom::{GridFrame, LatticeBounds, LatticeRegion};
use corniche_spec::{data_tiles::DataTiles, points_step::points_step};

/// Where objects of layers without heights are wanted.
#[derive(Clone, Copy)]
pub(crate) struct PlanSplitting<'a> {
    pub frame: &'a GridFrame,
    pub data: DataTiles,
    /// The bounds that were asked for: tiles that do not touch them get no lines.
    pub clip: Option<LatticeBounds>,
    /// The polygon that was asked for: areas and lines end at its outline.
    pub polygon: Option<&'a LatticeRegion>,
}

impl PlanSplitting<'_> {
    /// The spacing of the lattice on which points of a level lie, in steps of the package's: a power of two.
    pub(crate) fn step(&self, level: u8) -> i64 {
        points_step(self.frame, level)
    }
}
