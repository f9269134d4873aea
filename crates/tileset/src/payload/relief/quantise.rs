//! Coefficients to whole steps and back.

use super::head::{BANDS, MOST_UNITS};
use super::wavelet::{self, Band, LEVELS, SIDE, SMOOTH, rough_bands};
use crate::payload::damage::Damage;

/// Each band with its place in the list of steps: the smooth one, then the coarsest rough ones.
fn bands() -> impl Iterator<Item = (usize, Band)> {
    let rough = (0..LEVELS).rev().flat_map(rough_bands);
    std::iter::once(SMOOTH).chain(rough).enumerate()
}

fn each(square: &mut [i64], band: Band, mut change: impl FnMut(&mut i64)) {
    for row in 0..band.rows {
        let from = (band.top + row) * SIDE + band.left;
        square[from..from + band.columns].iter_mut().for_each(&mut change);
    }
}

/// Coefficients to whole steps. Those of the finest division become 0 below 0.7 of a step, those of the next below 0.6: most of them
/// are noise that shading does not miss.
#[cfg(feature = "write")]
pub(crate) fn quantise(square: &mut [i64], steps: &[i64; BANDS]) {
    for (number, band) in bands() {
        let step = steps[number];
        let added = match BANDS - number {
            1..=3 => step * 3 / 10,
            4..=6 => step * 4 / 10,
            _ => step / 2,
        };
        each(square, band, |value| *value = value.signum() * ((value.abs() + added) / step));
    }
}

/// Whole steps to coefficients, and these to heights in units.
pub(crate) fn reconstruct(square: &mut [i64], steps: &[i64; BANDS]) -> Result<(), Damage> {
    /// Five inverse divisions make values at most 2^13 times as large.
    const MOST: u64 = MOST_UNITS << 5;
    let mut is_small = true;
    for (number, band) in bands() {
        each(square, band, |value| {
            *value = value.saturating_mul(steps[number]);
            is_small &= value.unsigned_abs() <= MOST;
        });
    }
    let too_large = Err(Damage::Invalid("a height of the relief"));
    if !is_small {
        return too_large;
    }
    wavelet::inverse(square);
    if square.iter().any(|value| value.unsigned_abs() > MOST_UNITS) { too_large } else { Ok(()) }
}
