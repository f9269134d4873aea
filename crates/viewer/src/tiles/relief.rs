use corniche_drape::near_ground;
use corniche_geom::{Frame, TileId};
use corniche_tin::Surface;

use super::NearHeights;

/// What the roads of a tile are told of its ground when they are placed.
///
/// Found when a tile is decoded and not stored: it follows from what is stored, and takes a few microseconds a segment.
pub(super) struct Relief<'a> {
    frame: &'a Frame,
    /// `None` without ground, or without roads to ask.
    surface: Option<&'a Surface>,
    reach_steps: f64,
}

impl<'a> Relief<'a> {
    /// The ground of tile `id`.
    pub(super) fn new(id: TileId, surface: Option<&'a Surface>, frame: &'a Frame) -> Self {
        let reach_m = NearHeights::reach_m(frame.tile_bounds(id).width());
        Self { frame, surface, reach_steps: reach_m / frame.lattice_step_m() }
    }

    /// True heights of the ground beneath a segment in plan and how many metres they rise per metre away from it;
    /// `None` when there is no ground within [`NearHeights::reach_m`].
    pub(super) fn near(&self, ends_m: [[f64; 2]; 2]) -> Option<([f64; 2], f64)> {
        let ends = ends_m.map(|at| self.frame.fraction_of_position(at));
        let found = near_ground(ends, self.surface?, self.reach_steps)?;
        Some((found.range_m, found.rise_m / self.frame.lattice_step_m()))
    }

    /// How many true metres the ground at a position rises per metre east and per metre north; level where there is
    /// none.
    pub(super) fn gradient(&self, at_m: [f64; 2]) -> [f64; 2] {
        let found = self.surface.and_then(|surface| {
            let triangle = surface.locate(self.frame.snap(at_m)?)?;
            Some(surface.gradient_m(triangle).map(|rise_m| rise_m / self.frame.lattice_step_m()))
        });
        found.unwrap_or_default()
    }
}
