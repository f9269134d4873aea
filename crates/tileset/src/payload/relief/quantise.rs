//! Converts coefficients to whole steps and back.

use super::{
    head::{BANDS, MOST_UNITS},
    wavelet::{self, Band, LEVELS, SIDE, SMOOTH, rough_bands},
};
use crate::payload::damage::{Damage, Result};

/// Each band with its index in the list of steps: the smooth band, then the rough bands, the
/// coarsest first.
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

/// Converts coefficients to whole steps. In the finest division coefficients below 0.7 of a step
/// become 0, in the next those below 0.6: most of them are noise whose absence is not visible in
/// shading.
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

/// Converts whole steps to coefficients, and coefficients to heights in units.
pub(crate) fn reconstruct(square: &mut [i64], steps: &[i64; BANDS]) -> Result<()> {
    /// Five inverse divisions multiply values by at most 2^13.
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
