//! Where a line lies along its way.

use super::smooth_line::{SmoothLine, Station};
use crate::piece::Vertex;

/// Places that are nearer to an end of a line than this, lattice steps beyond the nearest, may be where it lies: a millimetre each at most.
const NEAR_STEPS: f64 = 500.0;

/// The distances along a way between which a line lies, which is as long; `None` where nothing is known of the way.
///
/// An end can lie at several distances, where a way comes back to itself. Of all pairs those count that are as far apart as the line is long.
pub(crate) fn stretch_of_way(
    way: &[SmoothLine],
    line: &[Vertex],
    length_m: f64,
) -> Option<[f64; 2]> {
    let [first, last] = [line.first()?, line.last()?].map(|end| distances_near(way, end.at));
    let pairs = first.iter().flat_map(|&from_m| last.iter().map(move |&to_m| [from_m, to_m]));
    let misfit = |[from_m, to_m]: &[f64; 2]| (to_m - from_m - length_m).abs();
    let best = pairs.min_by(|one, other| misfit(one).total_cmp(&misfit(other)));
    best.filter(|[from_m, to_m]| from_m < to_m)
}

/// The distances along a way at which it comes as near to a place as it does anywhere.
fn distances_near(way: &[SmoothLine], at: [f64; 2]) -> Vec<f64> {
    let segments = || way.iter().flat_map(|line| line.stations.array_windows::<2>());
    let all: Vec<[f64; 2]> = segments().map(|[from, to]| nearest(*from, *to, at)).collect();
    let least = all.iter().map(|[steps, _]| *steps).fold(f64::INFINITY, f64::min);
    let near = all.into_iter().filter(|[steps, _]| *steps <= least + NEAR_STEPS);
    near.map(|[_, along_m]| along_m).collect()
}

/// How near a segment comes to a place, lattice steps, and at which distance along the way.
fn nearest(from: Station, to: Station, at: [f64; 2]) -> [f64; 2] {
    let run = [to.at[0] - from.at[0], to.at[1] - from.at[1]];
    let off = [at[0] - from.at[0], at[1] - from.at[1]];
    let square = run[0].powi(2) + run[1].powi(2);
    let share = if square > 0.0 { (run[0] * off[0] + run[1] * off[1]) / square } else { 0.0 };
    let share = share.clamp(0.0, 1.0);
    let steps = (off[0] - share * run[0]).hypot(off[1] - share * run[1]);
    [steps, from.along_m + share * (to.along_m - from.along_m)]
}

#[cfg(test)]
#[path = "on_way_tests.rs"]
mod tests;
