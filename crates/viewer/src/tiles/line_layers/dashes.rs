//! Dash positions of a line on the ground: dash lengths are true along the ground, not in plan.

use super::super::{DashPlace, distance};

/// Lengths of the ground under each segment of a line.
///
/// ```text
///            ╱╲        ground: g metres              Between two points of the line, dashes are stretched evenly, by g / p.
///        ___╱  ╲___                                  So both methods have them at the same places, though volumes (SV) know
///   ────●──────────●────  segment: p metres          nothing of the ground in between.
/// ```
pub(crate) struct GroundLengths {
    /// Points in plan, working metres.
    points_m: Vec<[f64; 2]>,
    /// For each segment, how much of it is on ground of the tile, in plan and along the ground.
    lengths_m: Vec<[f64; 2]>,
}

impl GroundLengths {
    /// No lengths yet, for a line with these points.
    pub(crate) fn new(points_m: Vec<[f64; 2]>) -> Self {
        let lengths_m = vec![[0.0; 2]; points_m.len().saturating_sub(1)];
        Self { points_m, lengths_m }
    }

    /// Adds a piece of a segment that is on the ground between these points. `vertical_scale` is
    /// the world height of a metre of true height.
    pub(crate) fn add(&mut self, segment: usize, ends_m: [[f64; 3]; 2], vertical_scale: f64) {
        let [from, to] = ends_m;
        let plan_m = libm::hypot(to[0] - from[0], to[1] - from[1]);
        if let Some(sums) = self.lengths_m.get_mut(segment) {
            sums[0] += plan_m;
            sums[1] += libm::hypot(plan_m, (to[2] - from[2]) * vertical_scale);
        }
    }

    /// The dash positions of each segment.
    pub(crate) fn places(self) -> DashPlaces {
        let mut along_m = 0.0;
        let segments = self.points_m.array_windows::<2>().zip(&self.lengths_m);
        let of_segments = segments.map(|([from, to], [plan_m, ground_m])| {
            // A part that is not on ground of the tile is not drawn there.
            let rate = if *plan_m > 0.0 { ground_m / plan_m } else { 1.0 };
            let start_m = along_m;
            along_m += rate * distance(*from, *to);
            (*from, start_m, rate)
        });
        DashPlaces(of_segments.collect())
    }
}

/// For each segment of a line: its start, the distance of the start along the line, and metres
/// along the line per metre in plan.
pub(crate) struct DashPlaces(Vec<([f64; 2], f64, f64)>);

impl DashPlaces {
    /// The dashes of a part of a segment that starts at this point.
    pub(crate) fn at(&self, segment: usize, start: [f64; 2]) -> DashPlace {
        let Some((from, start_m, rate)) = self.0.get(segment) else { return DashPlace::flat(0.0) };
        DashPlace::new(start_m + rate * distance(*from, start), *rate)
    }
}
