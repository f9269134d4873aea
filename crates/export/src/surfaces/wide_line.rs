//! Chooses the points through which a wide line is drawn: inside turns, sides of short segments
//! would cross.
//!
//! ```text
//!   ─────────────◦
//!          back  │╲        The inner sides end `back` before the turn and begin `back` after it: half the width
//!   ─────◇╌╌╌╌╌╌╌◦ ╲       times the tangent of half the turn. A segment is long enough for the backs of both its ends,
//!         ╲                or one of them is removed.
//! ```

use corniche_geom::LatticePoint;

use crate::plane::{nearest, steps_between, vector};

/// A point is removed only if that moves the line by no more than this share of half its width.
const MOST_MOVED: f64 = 0.25;

/// Returns the numbers of the points that are kept, in order: always the first and the last, and
/// all others that the line needs.
pub(crate) fn wide_points(points: &[LatticePoint], half_width: f64) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::with_capacity(points.len());
    for next in 0..points.len() {
        kept.push(next);
        while let Some(left_out) = too_many(points, &kept, half_width) {
            kept.remove(left_out);
        }
    }
    kept
}

/// Returns the index among the kept points of one of the last that has too little space, and that
/// the line does not need.
fn too_many(points: &[LatticePoint], kept: &[usize], half_width: f64) -> Option<usize> {
    let last = kept.len();
    let at = |place: usize| points[kept[place]];
    let back = |place: usize| half_width * half_turn(at(place - 1), at(place), at(place + 1));
    let length = |place: usize| at(place).distance_steps(at(place + 1));
    let moved = |place: usize| beside([at(place - 1), at(place + 1)], at(place));
    let is_free = |place: &usize| moved(*place) <= MOST_MOVED * half_width;
    let turn = last.checked_sub(2).filter(|turn| *turn > 0)?;
    if back(turn).abs() > length(turn - 1).min(length(turn)) && is_free(&turn) {
        return Some(turn);
    }
    let before = Some(turn - 1).filter(|before| *before > 0)?;
    let [one, other] = [before, turn].map(back);
    let have_room = one * other <= 0.0 || (one + other).abs() <= length(before);
    let mut either = [before, turn].into_iter().filter(is_free);
    if have_room {
        return None;
    }
    let first = either.next()?;
    Some(either.next().filter(|second| moved(*second) < moved(first)).unwrap_or(first))
}

/// The tangent of half the turn at a point; negative to the right.
fn half_turn(from: LatticePoint, at: LatticePoint, to: LatticePoint) -> f64 {
    let [a, b] = [steps_between(from, at), steps_between(at, to)];
    let cross = a[0] * b[1] - a[1] * b[0];
    let tangent = cross / (a[0].hypot(a[1]) * b[0].hypot(b[1]) + a[0] * b[0] + a[1] * b[1]);
    // A line that turns back on itself.
    if tangent.is_nan() { f64::INFINITY } else { tangent }
}

/// Returns the distance of a point from a segment.
fn beside([from, to]: [LatticePoint; 2], at: LatticePoint) -> f64 {
    let [from, to, at] = [from, to, at].map(LatticePoint::in_steps);
    let [_, off] = nearest(vector(from, to), vector(from, at));
    off
}

#[cfg(test)]
#[path = "wide_line_tests.rs"]
mod tests;
