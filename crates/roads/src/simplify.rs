//! Simplifies road lines within a tolerance; the result does not depend on a line's direction.

use corniche_geom::{LatticePoint, Polyline, cross, dot};

/// The maximum number of rounds in which a stretch is divided, each time in all its parts at once.
/// Then all remaining points are kept. A line that goes back and forth loses no points anyway, and
/// would be scanned once for each of its points.
const MOST_ROUNDS: usize = 128;

/// Returns a line with fewer points: no point of the source is farther than `tolerance_steps`
/// (lattice steps) from the segment that replaces its stretch.
///
/// The ends and the points whose indices are in `fixed` are kept. A tolerance of 0 (or below, or
/// NaN) keeps every point. The result does not depend on the direction of the way: a way and its
/// reverse keep the same points, except where a way runs back over itself point by point and so has
/// no direction. In a stretch that returns to its start (a ring between junctions), the farthest
/// point is always kept, so that the line never vanishes. A ring smaller than the tolerance becomes
/// one segment back and forth.
///
/// After simplification, lines may cross themselves or others where they did not before, as with
/// any simplification by distance alone.
///
/// Source: Douglas & Peucker 1973, *Algorithms for the Reduction of the Number of Points Required
/// to Represent a Digitized Line*. Changes: the distance is measured to the *segment*, not to its
/// infinite line, because a stretch may run past its ends; a stretch that returns to its start
/// keeps its farthest point; and among points at equal distance the choice does not depend on the
/// direction of the way. `geo`'s implementation does not promise the last two; tests compare with
/// it in all other cases.
#[must_use]
pub fn simplify(line: &Polyline, fixed: &[u32], tolerance_steps: f64) -> Polyline {
    let kept = kept_points(line, fixed, tolerance_steps);
    let points = line.points();
    if kept.len() == points.len() {
        return line.clone();
    }
    // A polyline has two different neighbours somewhere; each stretch with such a pair keeps one.
    let kept = kept.into_iter().map(|index| points[index]).collect();
    Polyline::new(kept).unwrap_or_else(|_| line.clone())
}

/// Returns the indices of the points that [`simplify`] keeps, ascending.
#[must_use]
pub fn kept_points(line: &Polyline, fixed: &[u32], tolerance_steps: f64) -> Vec<usize> {
    // With this comparison NaN keeps every point, too.
    let reduces = tolerance_steps > 0.0;
    let points = line.points();
    if !reduces || points.len() <= 2 {
        return (0..points.len()).collect();
    }
    let last = points.len() - 1;
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[last] = true;
    for &index in fixed {
        if let Some(flag) = keep.get_mut(index as usize) {
            *flag = true;
        }
    }
    let mut start = 0;
    for end in 1..=last {
        if keep[end] {
            thin_stretch(points, start, end, tolerance_steps, &mut keep);
            start = end;
        }
    }
    (0..points.len()).filter(|&index| keep[index]).collect()
}

/// Marks the points of `points[first..=last]` to keep; its ends are already marked.
fn thin_stretch(
    points: &[LatticePoint],
    first: usize,
    last: usize,
    tolerance_steps: f64,
    keep: &mut [bool],
) {
    let is_reversed = is_reversed(&points[first..=last]);
    let mut pending = vec![(first, last)];
    for _ in 0..MOST_ROUNDS {
        let mut parts = Vec::new();
        for (first, last) in pending {
            let Some((farthest, distance_steps)) = farthest(points, first, last, is_reversed)
            else {
                continue;
            };
            // If both ends are equal, there is no segment: without this point the stretch would
            // vanish.
            if distance_steps > tolerance_steps || points[first] == points[last] {
                keep[farthest] = true;
                parts.extend([(first, farthest), (farthest, last)]);
            }
        }
        if parts.is_empty() {
            return;
        }
        pending = parts;
    }
    for (first, last) in pending {
        keep[first..last].fill(true);
    }
}

/// Returns the point strictly between `first` and `last` that is farthest from the segment between
/// them; among equals, the first in canonical direction.
fn farthest(
    points: &[LatticePoint],
    first: usize,
    last: usize,
    is_reversed: bool,
) -> Option<(usize, f64)> {
    // Both directions must compute the same numbers, so the segment also runs in canonical
    // direction.
    let (a, b) =
        if is_reversed { (points[last], points[first]) } else { (points[first], points[last]) };
    let mut best = None;
    for (index, &point) in points.iter().enumerate().take(last).skip(first + 1) {
        let distance_steps = distance_to_segment_steps(point, a, b);
        let is_farther = best.is_none_or(|(_, best_steps)| {
            if is_reversed { distance_steps >= best_steps } else { distance_steps > best_steps }
        });
        if is_farther {
            best = Some((index, distance_steps));
        }
    }
    best
}

/// Whether the canonical direction of this stretch is from its end to its start. The canonical
/// direction is the one whose points come first in lexicographic order. A stretch that equals its
/// reverse has no direction.
fn is_reversed(stretch: &[LatticePoint]) -> bool {
    stretch.iter().rev().lt(stretch.iter())
}

/// Returns the distance from `p` to the segment between `a` and `b`, in lattice steps. Products are
/// exact integers, so the result is off by at most a few units in the last place, however far apart
/// the points are.
fn distance_to_segment_steps(p: LatticePoint, a: LatticePoint, b: LatticePoint) -> f64 {
    let along = dot(a, b, p);
    if along <= 0 {
        return p.distance_steps(a);
    }
    if along >= dot(a, b, b) {
        return p.distance_steps(b);
    }
    cross(a, b, p).unsigned_abs() as f64 / a.distance_steps(b)
}

#[cfg(test)]
#[path = "simplify_tests.rs"]
mod tests;
