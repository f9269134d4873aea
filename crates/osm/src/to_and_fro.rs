//! Ways that go to and fro over one place far more often than a road can.

use std::collections::HashMap;

use corniche_geom::{LatticePoint, Polyline};

/// The maximum length of a way in one square, in sides of the square. A finest tile has 256 × 256
/// cells: on its ground such a way has some two hundred thousand vertices, a twentieth of a tile's
/// limit.
const MOST_SIDES: f64 = 256.0;

/// Ways with at most this many segments are not checked. A segment within a square is at most as
/// long as the square's diagonal, so a few misplaced nodes cause no work.
const FEW_SEGMENTS: usize = 181;

/// The maximum length of a way with more segments, in sides of a square: 24 million kilometres with
/// squares of 23 km, once around the Earth with squares of 40 m. This bounds work and memory.
const MOST_SQUARES: f64 = 1_048_576.0;

/// Whether the lines of a way together go to and fro over a square of `side` lattice steps more
/// often than a road can. Squares cover the whole lattice, so the result does not depend on the
/// extent of a package.
pub(crate) fn go_to_and_fro(lines: &[&Polyline], side: i64) -> bool {
    let side = side.max(1) as f64;
    let segments = || {
        let pairs = lines.iter().flat_map(|line| line.points().array_windows());
        pairs.map(|ends| ends.map(LatticePoint::in_steps))
    };
    // Nearly every road is done here.
    if segments().nth(FEW_SEGMENTS).is_none() {
        return false;
    }
    let length: f64 = segments().map(length_of).sum();
    if length <= MOST_SIDES * side {
        return false;
    }
    if length > MOST_SQUARES * side {
        return true;
    }
    let mut squares: HashMap<[i64; 2], f64> = HashMap::new();
    for segment in segments() {
        for (column, part) in strips(segment, 0, side) {
            for (row, part) in strips(part, 1, side) {
                let within = squares.entry([column, row]).or_default();
                *within += length_of(part);
                if *within > MOST_SIDES * side {
                    return true;
                }
            }
        }
    }
    false
}

fn length_of([a, b]: [[f64; 2]; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// Cuts a segment at the multiples of `side` along one axis. Returns the number of each strip, and
/// the part within it.
fn strips(
    [a, b]: [[f64; 2]; 2],
    axis: usize,
    side: f64,
) -> impl Iterator<Item = (i64, [[f64; 2]; 2])> {
    let (low, high) = if a[axis] <= b[axis] { (a, b) } else { (b, a) };
    let [first, last] = [low, high].map(|at| (at[axis] / side).floor() as i64);
    let other = 1 - axis;
    let slope =
        if first == last { 0.0 } else { (high[other] - low[other]) / (high[axis] - low[axis]) };
    let at = move |strip: i64| {
        let along = strip as f64 * side;
        let across = low[other] + slope * (along - low[axis]);
        if axis == 0 { [along, across] } else { [across, along] }
    };
    (first..=last).map(move |strip| {
        let from = if strip == first { low } else { at(strip) };
        let to = if strip == last { high } else { at(strip + 1) };
        (strip, [from, to])
    })
}

#[cfg(test)]
#[path = "to_and_fro_tests.rs"]
mod tests;
