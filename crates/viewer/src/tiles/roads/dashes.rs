//! Dash positions of tunnels and lines.

use corniche_geom::Bounds;

use super::super::distance;

/// Lengths are counted modulo this many metres, so that f32 is precise enough. It is a power of
/// two, like the length of dashes.
const WRAP_M: f64 = 65_536.0;

/// Dash positions on a segment, for shaders: the distance of the segment's start along the line,
/// working metres, and the number of such metres per metre of the segment in plan, more than 1
/// uphill, if dashes are on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DashPlace(pub(crate) [f32; 2]);

impl DashPlace {
    /// The dashes of a segment that starts `start_m` along its line; `rate` is metres along the
    /// line per metre in plan.
    pub(crate) fn new(start_m: f64, rate: f64) -> Self {
        Self([start_m.rem_euclid(WRAP_M) as f32, rate as f32])
    }

    /// Does the same as [`DashPlace::new`] for dashes that are measured in plan.
    pub(crate) fn flat(start_m: f64) -> Self {
        Self::new(start_m, 1.0)
    }

    /// The place that is `by_m` along the line from this one, in plan.
    pub(crate) fn moved(self, by_m: f64) -> Self {
        let [start_m, rate] = self.0.map(f64::from);
        Self::new(start_m + rate * by_m, rate)
    }
}

/// The dash position of each segment of a line: the distance of its start along the road. Dashes
/// are counted from there, so they continue at the bends of the road.
///
/// ```text
///               tile            GEO lines begin and end at the border, SV lines at the margin beyond it.
///   ┌─────────────────────────┐ So lengths are counted from the first vertex inside the tile, which both have: from a,
/// ──┼──a────b                 │ and again from d, where the line comes back. A road that goes through the tile without a
///   │        ╲     ╱──e───    │ vertex is counted from a fixed place of the CRS (`dash_of_segment_m`).
///   └─────────╲───d───────────┘
///              c
/// ```
///
/// A tile does not know the length of a way before it, so at the border between two tiles dashes
/// start again.
pub(crate) fn dash_starts(vertices_m: &[[f64; 2]], tile: Bounds) -> Vec<DashPlace> {
    let slack_m = 1e-9 * tile.width();
    let around = tile.expanded([slack_m; 2]);
    let is_inside = |at: [f64; 2]| around.contains(at);
    // The length up to the current vertex, if the vertex is inside.
    let mut reached_m = vertices_m.first().filter(|first| is_inside(**first)).map(|_| 0.0);
    let segments = vertices_m.windows(2).map(|pair| {
        let length_m = distance(pair[0], pair[1]);
        let ends_inside = is_inside(pair[1]);
        let start_m = match reached_m {
            Some(start_m) => start_m,
            None if ends_inside => -length_m,
            None => dash_of_segment_m([pair[0], pair[1]]),
        };
        reached_m = ends_inside.then_some(start_m + length_m);
        DashPlace::flat(start_m)
    });
    segments.collect()
}

/// The distance of a single segment's start along its direction, counted from the zero of the CRS.
pub(crate) fn dash_of_segment_m([start, end]: [[f64; 2]; 2]) -> f64 {
    let [dx, dy] = [end[0] - start[0], end[1] - start[1]];
    let length_m = libm::hypot(dx, dy);
    if length_m == 0.0 {
        return 0.0;
    }
    ((start[0] * dx + start[1] * dy) / length_m).rem_euclid(WRAP_M)
}

#[cfg(test)]
#[path = "dashes_tests.rs"]
mod tests;
