//! The transform: the reversible 5/3 wavelet in whole numbers, over a square of nodes.
//!
//! Source: Le Gall & Tabatabai 1988, *Sub-band coding of digital images using symmetric short
//! kernel filters*, in the lifting form of JPEG 2000 (ISO/IEC 15444-1, annex F).

use corniche_geom::TILE_NODES;

/// Number of nodes on a side of the square.
pub(crate) const SIDE: usize = TILE_NODES;
/// Number of divisions: the smooth part is divided again and again.
pub(crate) const LEVELS: usize = 5;

/// Sides of the smooth part: of the whole square, and after 1, 2 … divisions. An odd side of 2n + 1
/// has n + 1 smooth and n rough values.
pub(crate) const SIDES: [usize; LEVELS + 1] = {
    let mut sides = [SIDE; LEVELS + 1];
    let mut k = 1;
    while k <= LEVELS {
        sides[k] = sides[k - 1].div_ceil(2);
        k += 1;
    }
    sides
};

/// A rectangle of coefficients in the transformed square.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Band {
    pub left: usize,
    pub top: usize,
    pub columns: usize,
    pub rows: usize,
}

/// The smooth part that remains after all divisions.
pub(crate) const SMOOTH: Band =
    Band { left: 0, top: 0, columns: SIDES[LEVELS], rows: SIDES[LEVELS] };

/// The three rough bands of a division, with `level` 0 for the finest: rough from west to east,
/// from north to south, in both directions.
pub(crate) fn rough_bands(level: usize) -> [Band; 3] {
    let (all, half) = (SIDES[level], SIDES[level + 1]);
    let rest = all - half;
    [
        Band { left: half, top: 0, columns: rest, rows: half },
        Band { left: 0, top: half, columns: half, rows: rest },
        Band { left: half, top: half, columns: rest, rows: rest },
    ]
}

/// Transforms the square in place.
#[cfg(feature = "write")]
pub(crate) fn forward(square: &mut [i64]) {
    let mut line = [0; SIDE];
    for &side in &SIDES[..LEVELS] {
        for at in 0..side {
            each_line(square, side, at, SIDE, 1, |values| divide(values, &mut line));
        }
        for at in 0..side {
            each_line(square, side, at, 1, SIDE, |values| divide(values, &mut line));
        }
    }
}

/// The inverse of [`forward`], exactly.
pub(crate) fn inverse(square: &mut [i64]) {
    let mut line = [0; SIDE];
    for &side in SIDES[..LEVELS].iter().rev() {
        for at in 0..side {
            each_line(square, side, at, 1, SIDE, |values| join(values, &mut line));
        }
        for at in 0..side {
            each_line(square, side, at, SIDE, 1, |values| join(values, &mut line));
        }
    }
}

/// Changes one line after another of the square: each line begins at `at` times `start_step`, and
/// its values are `step` apart.
fn each_line(
    square: &mut [i64],
    side: usize,
    at: usize,
    start_step: usize,
    step: usize,
    change: impl FnOnce(&mut [i64]),
) {
    let mut values = [0; SIDE];
    for k in 0..side {
        values[k] = square[at * start_step + k * step];
    }
    change(&mut values[..side]);
    for k in 0..side {
        square[at * start_step + k * step] = values[k];
    }
}

/// Converts a line of 2n + 1 values to n + 1 smooth values, then n rough values.
///
/// ```text
///   x0   x1   x2   x3   x4
///    │  ╲ │ ╱ │  ╲ │ ╱  │       rough:  d = odd − mean of both even neighbours
///    s0   d0   s1   d1   s2      smooth: s = even + a quarter of both rough neighbours
/// ```
#[cfg(feature = "write")]
fn divide(values: &mut [i64], line: &mut [i64; SIDE]) {
    let rough = values.len() / 2;
    for k in 0..rough {
        values[2 * k + 1] -= (values[2 * k] + values[2 * k + 2]) >> 1;
    }
    for k in 0..=rough {
        values[2 * k] += (beside(values, k) + 2) >> 2;
    }
    for k in 0..=rough {
        line[k] = values[2 * k];
    }
    for k in 0..rough {
        line[rough + 1 + k] = values[2 * k + 1];
    }
    values.copy_from_slice(&line[..values.len()]);
}

/// The inverse of [`divide`].
fn join(values: &mut [i64], line: &mut [i64; SIDE]) {
    let rough = values.len() / 2;
    for k in 0..=rough {
        line[2 * k] = values[k];
    }
    for k in 0..rough {
        line[2 * k + 1] = values[rough + 1 + k];
    }
    let values_out = &mut line[..values.len()];
    for k in 0..=rough {
        values_out[2 * k] -= (beside(values_out, k) + 2) >> 2;
    }
    for k in 0..rough {
        values_out[2 * k + 1] += (values_out[2 * k] + values_out[2 * k + 2]) >> 1;
    }
    values.copy_from_slice(values_out);
}

/// The sum of the rough values on both sides of smooth value `k`; at an end the only one counts
/// twice.
fn beside(values: &[i64], k: usize) -> i64 {
    let last = values.len() / 2;
    let before = values[if k == 0 { 1 } else { 2 * k - 1 }];
    let after = values[if k == last { 2 * k - 1 } else { 2 * k + 1 }];
    before + after
}

#[cfg(all(test, feature = "write"))]
#[path = "wavelet_tests.rs"]
mod tests;
