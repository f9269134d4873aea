//! Properties of a tile's ground that are needed for placing its roads.

use corniche_drape::{GroundSegment, near_ground, road_bed};
use corniche_geom::{Bounds, GridFrame, StepBudget, TileId};
use corniche_tin::Surface;

use super::{
    Bed, GroundLine,
    roads::LinePiece,
    slopes::{Plane, Slopes},
};

/// Computes the properties of a tile's ground that are needed for placing its roads.
///
/// They are computed when a tile is decoded. They are not stored, because they follow from stored
/// data and take only a few microseconds per segment.
pub(crate) struct RoadRelief<'a> {
    frame: &'a GridFrame,
    /// `None` without ground or without roads.
    surface: Option<&'a Surface>,
    tile: Bounds,
    /// The distances within which the bounds of a bed apply; see [`Bed::reaches_m`].
    reaches_m: [f64; 3],
    /// After too much work, results are invalid: the caller must check the budget at the end.
    work: &'a StepBudget,
}

impl<'a> RoadRelief<'a> {
    /// The ground of tile `id`, whose roads are drawn up to `width_margin_m` wide to each side.
    pub(crate) fn new(
        id: TileId,
        surface: Option<&'a Surface>,
        frame: &'a GridFrame,
        width_margin_m: f64,
        work: &'a StepBudget,
    ) -> Self {
        let tile = frame.tile_bounds(id);
        let reaches_m = Bed::reaches_m([tile.width(), tile.height()], width_margin_m);
        Self { frame, surface, tile, reaches_m, work }
    }

    /// The range of true heights of the ground below a segment in plan, and how many metres it
    /// grows per metre away from the segment; `None` if there is no ground within
    /// [`NearHeights::reach_m`].
    pub(crate) fn near(&self, ends_m: [[f64; 2]; 2]) -> Option<([f64; 2], f64)> {
        self.work.check().ok()?;
        let ends = ends_m.map(|at| self.frame.fraction_of_position(at));
        let [reach_m, ..] = self.reaches_m;
        let reach = reach_m / self.frame.lattice_step_m();
        let found = near_ground(ends, self.surface?, reach, self.work)?;
        Some((found.range_m, found.rise_m / self.frame.lattice_step_m()))
    }

    /// The ground for roads that are much wider than a cell; `None` without ground or without
    /// lines.
    pub(crate) fn wide(&self, lines: &[GroundLine]) -> Option<Slopes> {
        let surface = self.surface.filter(|_| !lines.is_empty())?;
        Some(Slopes::of_surface(surface, self.tile, self.frame))
    }

    /// The ground next to a piece of a road; `wide` is the same ground for wide roads. Without
    /// ground the bed is level.
    pub(crate) fn bed(&self, piece: &LinePiece, wide: Option<&Slopes>) -> Bed {
        let (Some(surface), Some(wide), Ok(())) = (self.surface, wide, self.work.check()) else {
            return Bed::default();
        };
        let step_m = self.frame.lattice_step_m();
        let [[x, y, height_m], [_, _, end_height_m]] = piece.ends_m;
        let (direction, length_m) = (piece.direction(), piece.length_m());
        let road_piece = GroundSegment {
            start: self.frame.fraction_of_position([x, y]),
            direction,
            length: length_m / step_m,
            heights_m: [height_m, end_height_m],
            has_caps: piece.has_caps,
        };
        let near = road_bed(&road_piece, surface, self.reaches_m[0] / step_m, self.work);
        let along = if length_m > 0.0 { (end_height_m - height_m) / length_m } else { 0.0 };
        let across = near.cross_rise_m / step_m;
        let [east, north] = direction;
        let plane = Plane {
            at_m: [x, y],
            height_m,
            gradient: [along * east - across * north, along * north + across * east],
        };
        let mut most_m = [near.most_m; 3];
        let mut leaves_tile = [false; 3];
        for (k, reach_m) in self.reaches_m.into_iter().enumerate() {
            let corners_m = corners(piece, reach_m);
            if k > 0 {
                let found = wide.leaving(&plane, corners_m);
                // A wider strip includes the ground of the narrower one.
                most_m[k] = [0, 1].map(|side| found[side].max(most_m[k - 1][side]));
            }
            leaves_tile[k] = corners_m.iter().any(|at| !self.tile.contains(*at));
        }
        for (most_m, leaves_tile) in most_m.iter_mut().zip(leaves_tile) {
            if leaves_tile {
                // The neighbour's ground is unknown. It is assumed to be as rough as this tile's,
                // from the border on.
                *most_m = [2.0 * most_m[0].max(most_m[1]); 2];
            }
        }
        let rises = near.rises_m.map(|rise_m| rise_m / step_m);
        let rises = if leaves_tile[0] { [2.0 * rises[0].max(rises[1]); 2] } else { rises };
        Bed {
            slopes: [along, across].map(|slope| slope as f32),
            rises: rises.map(|rise| (rise as f32).next_up()),
            most_m: most_m.map(|most_m| most_m.map(|most_m| (most_m as f32).next_up())),
            leaves_tile,
        }
    }
}

/// The corners of the rectangle around a piece of a road and its caps, counter-clockwise.
fn corners(piece: &LinePiece, reach_m: f64) -> [[f64; 2]; 4] {
    let ([x, y, _], [east, north]) = (piece.ends_m[0], piece.direction());
    let beyond_m = piece.has_caps.map(|has_cap| if has_cap { reach_m } else { 0.0 });
    let (first_m, last_m) = (-beyond_m[0], piece.length_m() + beyond_m[1]);
    [[first_m, -reach_m], [last_m, -reach_m], [last_m, reach_m], [first_m, reach_m]].map(
        |[along_m, left_m]| {
            [x + along_m * east - left_m * north, y + along_m * north + left_m * east]
        },
    )
}
