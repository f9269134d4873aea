use corniche_drape::near_ground;
use corniche_geom::{Frame, TileId};
use corniche_tileset::Terrain;
use corniche_tin::{Placement, Surface};

use super::{NearHeights, TileLines};

/// What the roads of a tile are told of its ground when they are placed.
///
/// Found when a tile is decoded and not stored: it follows from what is stored, and takes a few microseconds a segment.
pub(super) struct Relief<'a> {
    frame: &'a Frame,
    /// `None` without ground, or without roads to ask.
    surface: Option<Surface>,
    reach_steps: f64,
}

impl<'a> Relief<'a> {
    /// The ground of tile `id`; see [`TileGeometry::assemble`](super::TileGeometry::assemble).
    pub(super) fn new(
        id: TileId,
        terrain: Option<&Terrain>,
        lines: &TileLines,
        frame: &'a Frame,
        quantum_m: f64,
    ) -> Self {
        let is_asked = !lines.ground.is_empty() || !lines.plan.is_empty();
        let surface = terrain
            .filter(|_| is_asked)
            .map(|terrain| Surface::new(&terrain.tin, Placement::of_tile(frame, id, quantum_m)));
        let reach_m = NearHeights::reach_m(frame.tile_bounds(id).width());
        Self { frame, surface, reach_steps: reach_m / frame.lattice_step_m() }
    }

    /// True heights of the ground beneath a segment in plan and how many metres they rise per metre away from it;
    /// `None` when there is no ground within [`NearHeights::reach_m`].
    pub(super) fn near(&self, ends_m: [[f64; 2]; 2]) -> Option<([f64; 2], f64)> {
        let ends = ends_m.map(|at| self.frame.fraction_of_position(at));
        let found = near_ground(ends, self.surface.as_ref()?, self.reach_steps)?;
        Some((found.range_m, found.rise_m / self.frame.lattice_step_m()))
    }

    /// How many true metres the ground at a position rises per metre east and per metre north; level where there is
    /// none.
    pub(super) fn gradient(&self, at_m: [f64; 2]) -> [f64; 2] {
        let found = self.surface.as_ref().and_then(|surface| {
            let triangle = surface.locate(self.frame.snap(at_m)?)?;
            Some(surface.gradient_m(triangle).map(|rise_m| rise_m / self.frame.lattice_step_m()))
        });
        found.unwrap_or_default()
    }
}
