//! The common part of splitting areas and lines by tile: the requested tiles, and the lattice of
//! each level.

use corniche_geom::{GridFrame, LatticeBounds, LatticeRegion};
use corniche_spec::{data_tiles::DataTiles, points_step::points_step};

/// The region for objects of layers without heights.
#[derive(Clone, Copy)]
pub(crate) struct PlanSplitting<'a> {
    pub frame: &'a GridFrame,
    pub data: DataTiles,
    /// The requested bounds: tiles that do not touch them get no lines.
    pub clip: Option<LatticeBounds>,
    /// The requested polygon: areas and lines are clipped to its outline.
    pub polygon: Option<&'a LatticeRegion>,
}

impl PlanSplitting<'_> {
    /// The spacing of the lattice for points of a level, in steps of the package's lattice: a power
    /// of two.
    pub(crate) fn step(&self, level: u8) -> i64 {
        points_step(self.frame, level)
    }
}
