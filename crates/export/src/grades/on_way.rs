//! Where a line lies along its way.

use corniche_tileset::Manifest;

use super::{
    smooth_line::{SmoothLine, Station},
    smoothing::MOST_SPACING_M,
};
use crate::{
    piece::Vertex,
    plane::{self, vector},
};

/// Places of a way that are at most so much farther from an end of a line than the nearest one may be where it lies, lattice steps: half a metre.
const ALIKE_STEPS: f64 = 500.0;
/// A line that is simplified is shorter than its way by no more than this share.
const SHORTER: f64 = 0.05;

/// How far ends of lines may be beside their ways, lattice steps: as far as the level's lines are simplified, and what is rounded.
pub(crate) fn most_steps(manifest: &Manifest, level: u8) -> f64 {
    let [east_m, north_m] = manifest.frame.level_cell(level).to_array();
    let simplified_m = manifest.settings.simplify_cells * east_m.max(north_m);
    (simplified_m + 2.0) / manifest.frame.lattice_step_m()
}

/// The distances along a way between which a line lies, which is as long; `None` where that is not known. Its ends are no farther from the way than
/// `most_steps`.
///
/// An end can lie at several distances, where a way comes back to itself. Of all pairs that count which is as far apart as the line is long.
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
        // Distances ascend: the best partner is next to where it should be.
        let after = last.partition_point(|&to_m| to_m < from_m + length_m);
        let near = [after.checked_sub(1), Some(after)].into_iter().flatten();
        near.filter_map(|at| last.get(at)).map(move |&to_m| [from_m, to_m]).collect::<Vec<_>>()
    });
    let ascending = pairs.filter(|[from_m, to_m]| from_m < to_m);
    let best = ascending.min_by(|one, other| misfit(one).total_cmp(&misfit(other)));
    best.filter(|pair| misfit(pair) <= SHORTER * length_m + 2.0 * MOST_SPACING_M)
}

/// The distances along a way at which it comes as near to a place as it does anywhere, ascending; none where that is not near.
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

/// How near a segment comes to a place, lattice steps, and at which distance along the way.
fn nearest(from: Station, to: Station, at: [f64; 2]) -> [f64; 2] {
    let [share, steps] = plane::nearest(vector(from.at, to.at), vector(from.at, at));
    // To the bit at its end, as lines are looked up by it.
    let along_m =
        if share >= 1.0 { to.along_m } else { from.along_m + share * (to.along_m - from.along_m) };
    [steps, along_m]
}

#[cfg(test)]
#[path = "on_way_tests.rs"]
mod tests;
