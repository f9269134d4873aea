//! Where the dashes of tunnels and lines are.

use corniche_geom::Bounds;

use super::super::distance;

/// Lengths are counted in whole lengths of this many metres, so that f32 is precise enough between them. A power of two, as the
/// dashes are.
const WRAP_M: f64 = 65_536.0;

/// Where dashes are on a segment, as shaders take it: how far along the line the segment's start is, working metres, and how many such metres make a
/// metre of the segment in plan, more than 1 uphill, if dashes lie on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DashPlace(pub(crate) [f32; 2]);

impl DashPlace {
    /// The dashes of a segment that starts this far along its line, with so many metres along the line for each metre in plan.
    pub(crate) fn new(start_m: f64, rate: f64) -> Self {
        Self([start_m.rem_euclid(WRAP_M) as f32, rate as f32])
    }

    /// The same, with dashes as long as they are in plan.
    pub(crate) fn flat(start_m: f64) -> Self {
        Self::new(start_m, 1.0)
    }

    /// The place that is so far along the line from this one, in plan.
    pub(crate) fn moved(self, by_m: f64) -> Self {
        let [start_m, rate] = self.0.map(f64::from);
        Self::new(start_m + rate * by_m, rate)
    }
}

/// Where the dashes of each segment of a line are: how far along the road its start is. Dashes are counted from there, so they go on
/// at the bends of the road.
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
/// A tile does not know the length of a way before it, so at the border between two tiles dashes begin anew.
pub(crate) fn dash_starts(vertices_m: &[[f64; 2]], tile: Bounds) -> Vec<DashPlace> {
    let slack_m = 1e-9 * tile.width();
    let is_inside = |[x, y]: [f64; 2]| {
        (tile.min_x - slack_m..=tile.max_x + slack_m).contains(&x)
            && (tile.min_y - slack_m..=tile.max_y + slack_m).contains(&y)
    };
    // The length up to the vertex reached, if it is inside.
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

/// How far the start of a segment alone is along its direction, counted from the CRS's zero.
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
