//! The position of a line along its way.

use corniche_tileset::Manifest;

use super::{
    smooth_line::{SmoothLine, Station},
    smoothing::MOST_SPACING_M,
};
use crate::{
    piece::Vertex,
    plane::{self, vector},
};

/// Places of a way also match an end of a line if they are farther from it than the nearest place
/// by at most this, lattice steps: half a metre.
const ALIKE_STEPS: f64 = 500.0;
/// A simplified line is shorter than its way by no more than this share.
const SHORTER: f64 = 0.05;

/// The largest distance of ends of lines from their ways, lattice steps: the tolerance to which the
/// level's lines are simplified, plus rounding.
pub(crate) fn most_steps(manifest: &Manifest, level: u8) -> f64 {
    let [east_m, north_m] = manifest.frame.level_cell(level).to_array();
    let simplified_m = manifest.settings.simplify_cells * east_m.max(north_m);
    (simplified_m + 2.0) / manifest.frame.lattice_step_m()
}

/// Returns the distances along a way between which a line of this length runs; `None` if that is
/// unknown. Its ends are no farther from the way than `most_steps`.
///
/// An end can match several distances if a way returns to itself. The pair whose distance is
/// nearest to the length of the line wins.
pub(crate) fn stretch_of_way(
    way: &[SmoothLine],
    line: &[Vertex],
    length_m: f64,
    most_steps: f64,
) -> Option<[f64; 2]> {
    let [first, last] =
        [line.first()?, line.last()?].map(|end| distances_near(way, end.at, most_steps));
    let misfit = |[from_m, to_m]: &[f64; 2]| (to_m - from_m - length_m).abs();
    let pairs = first.iter().flat_map(|&from_m| {
        // Distances ascend, so the best partner is next to its expected place.
        let after = last.partition_point(|&to_m| to_m < from_m + length_m);
        let near = [after.checked_sub(1), Some(after)].into_iter().flatten();
        near.filter_map(|at| last.get(at)).map(move |&to_m| [from_m, to_m]).collect::<Vec<_>>()
    });
    let ascending = pairs.filter(|[from_m, to_m]| from_m < to_m);
    let best = ascending.min_by(|one, other| misfit(one).total_cmp(&misfit(other)));
    best.filter(|pair| misfit(pair) <= SHORTER * length_m + 2.0 * MOST_SPACING_M)
}

/// Returns the distances along a way at which it is nearest to a place, ascending; none if it is
/// nowhere near.
fn distances_near(way: &[SmoothLine], at: [f64; 2], most_steps: f64) -> Vec<f64> {
    let segments = || way.iter().flat_map(|line| line.stations.array_windows::<2>());
    let all: Vec<[f64; 2]> = segments().map(|[from, to]| nearest(*from, *to, at)).collect();
    let least = all.iter().map(|[steps, _]| *steps).fold(most_steps, f64::min);
    let near = all.into_iter().filter(|[steps, _]| *steps <= (least + ALIKE_STEPS).min(most_steps));
    let mut distances_m: Vec<f64> = near.map(|[_, along_m]| along_m).collect();
    distances_m.sort_by(f64::total_cmp);
    distances_m.dedup();
    distances_m
}

/// Returns the distance of a place from a segment, lattice steps, and the distance along the way of
/// the nearest point.
fn nearest(from: Station, to: Station, at: [f64; 2]) -> [f64; 2] {
    let [share, steps] = plane::nearest(vector(from.at, to.at), vector(from.at, at));
    // Exact at the end of the segment, because lines are looked up by it.
    let along_m =
        if share >= 1.0 { to.along_m } else { from.along_m + share * (to.along_m - from.along_m) };
    [steps, along_m]
}

#[cfg(test)]
#[path = "on_way_tests.rs"]
mod tests;
