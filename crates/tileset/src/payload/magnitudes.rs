//! Codes numbers as bits: by their length in binary, which is predicted from two contexts.

use crate::payload::range_coder::{Bits, Model};

/// The largest number of binary digits of a magnitude.
const LENGTHS: usize = 33;
/// The number of digits after the leading 1 that have models.
const MODELLED_DIGITS: usize = 2;

/// The state of a coder of numbers of one kind. Each number has two contexts, with `FIRST` and
/// `SECOND` possible values.
#[derive(Debug, Clone)]
pub(crate) struct Magnitudes<const FIRST: usize, const SECOND: usize> {
    by_first: Vec<[Model; LENGTHS]>,
    by_second: Vec<[Model; LENGTHS]>,
    digits: [[Model; 1 << MODELLED_DIGITS]; LENGTHS],
}

impl<const FIRST: usize, const SECOND: usize> Default for Magnitudes<FIRST, SECOND> {
    fn default() -> Self {
        Self {
            by_first: vec![[Model::NEW; LENGTHS]; FIRST],
            by_second: vec![[Model::NEW; LENGTHS]; SECOND],
            digits: [[Model::NEW; 1 << MODELLED_DIGITS]; LENGTHS],
        }
    }
}

impl<const FIRST: usize, const SECOND: usize> Magnitudes<FIRST, SECOND> {
    /// Codes a number with a magnitude below 2^32; a context beyond the last counts as the last.
    pub(crate) fn code<B: Bits>(&mut self, bits: &mut B, contexts: [usize; 2], number: i64) -> i64 {
        let magnitude = self.code_magnitude(bits, contexts, number.unsigned_abs()) as i64;
        if magnitude != 0 && bits.even(u32::from(number < 0)) == 1 { -magnitude } else { magnitude }
    }

    /// Codes a number that is not negative, or whose sign is coded elsewhere.
    pub(crate) fn code_magnitude<B: Bits>(
        &mut self,
        bits: &mut B,
        [first, second]: [usize; 2],
        asked: u64,
    ) -> u64 {
        let wanted = (u64::BITS - asked.leading_zeros()) as usize;
        let lengths = self.by_first[first.min(FIRST - 1)]
            .iter_mut()
            .zip(&mut self.by_second[second.min(SECOND - 1)]);
        let mut length = 0;
        for (one, other) in lengths.take(LENGTHS - 1) {
            if bits.mixed([one, other], u32::from(wanted > length)) == 0 {
                break;
            }
            length += 1;
        }
        if length == 0 {
            return 0;
        }
        let models = &mut self.digits[length];
        let mut magnitude = 1_u64;
        for place in (0..length - 1).rev() {
            let digit = ((asked >> place) & 1) as u32;
            let digit = if magnitude < 1 << MODELLED_DIGITS {
                bits.bit(&mut models[magnitude as usize], digit)
            } else {
                bits.even(digit)
            };
            magnitude = magnitude << 1 | u64::from(digit);
        }
        magnitude
    }
}

/// Returns the half-octave of a number: 0 for 0, then 1, 2, 4 for 1, 2, 4, with one class between
/// powers of two.
pub(crate) fn half_octave(sum: u64) -> usize {
    match sum {
        0 | 1 => sum as usize,
        _ => {
            let exponent = sum.ilog2();
            2 * exponent as usize + ((sum >> (exponent - 1)) & 1) as usize
        }
    }
}

#[cfg(all(test, feature = "write"))]
#[path = "magnitudes_tests.rs"]
mod tests;
