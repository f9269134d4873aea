//! Codes the whole numbers of a rectangle, and the mask of nodes, as bits.

use super::wavelet::{Band, SIDE};
use crate::payload::range_coder::{Bits, Model};

/// Numbers up to this have one bit for each step; larger numbers have an exponent and the digits
/// that it announces.
const STEPS: usize = 14;
/// Number of exponents of the part of a number beyond [`STEPS`]: magnitudes stay below 2^41.
const EXPONENTS: usize = 41;
/// Number of classes of the sum of magnitudes around a number.
const CLASSES: usize = 15;
/// The sums of magnitudes at which the next class begins.
const CLASS_STARTS: [i64; CLASSES - 1] = [1, 2, 3, 4, 6, 8, 11, 15, 20, 28, 40, 60, 100, 200];

/// The state of a coder of numbers of one kind.
#[derive(Debug, Clone)]
pub(crate) struct NumberModel {
    steps: [[Model; STEPS]; CLASSES],
    exponents: [Model; EXPONENTS],
}

impl NumberModel {
    pub(crate) const fn new() -> Self {
        Self { steps: [[Model::NEW; STEPS]; CLASSES], exponents: [Model::NEW; EXPONENTS] }
    }

    /// Codes a number; `around` is a weighted sum of the magnitudes of the numbers near it.
    /// Magnitudes stay below 2^41.
    pub(crate) fn code<B: Bits>(&mut self, bits: &mut B, around: i64, number: i64) -> i64 {
        let class = CLASS_STARTS.iter().take_while(|&&start| around >= start).count();
        let asked = number.unsigned_abs();
        let mut magnitude = 0;
        for model in &mut self.steps[class] {
            if bits.bit(model, u32::from(asked > magnitude)) == 0 {
                break;
            }
            magnitude += 1;
        }
        if magnitude == STEPS as u64 {
            magnitude += self.code_rest(bits, asked.saturating_sub(STEPS as u64));
        }
        if magnitude > 0 && bits.even(u32::from(number < 0)) == 1 {
            -(magnitude as i64)
        } else {
            magnitude as i64
        }
    }

    /// Codes `rest` + 1 in Elias's gamma code with an adaptive exponent.
    fn code_rest<B: Bits>(&mut self, bits: &mut B, rest: u64) -> u64 {
        let wanted = (rest + 1).ilog2() as usize;
        let mut exponent = 0;
        while exponent < EXPONENTS - 1
            && bits.bit(&mut self.exponents[exponent], u32::from(wanted > exponent)) == 1
        {
            exponent += 1;
        }
        let mut value = 1;
        for place in (0..exponent).rev() {
            value = value << 1 | u64::from(bits.even((((rest + 1) >> place) & 1) as u32));
        }
        value - 1
    }
}

/// The magnitude of a number of a band; 0 outside the band.
fn magnitude(square: &[i64], band: Band, column: usize, row: usize) -> i64 {
    // A column or row before the first has wrapped around, so it is beyond the last.
    if column < band.columns && row < band.rows {
        square[(band.top + row) * SIDE + band.left + column].abs()
    } else {
        0
    }
}

/// Codes the numbers of a band, row by row. `parent` is the band of the same direction in the next
/// coarser division.
pub(crate) fn code_band<B: Bits>(
    bits: &mut B,
    numbers: &mut NumberModel,
    square: &mut [i64],
    band: Band,
    parent: Option<Band>,
) {
    for row in 0..band.rows {
        for column in 0..band.columns {
            let near = |left: usize, up: usize| {
                magnitude(square, band, column.wrapping_sub(left), row.wrapping_sub(up))
            };
            let north_east = magnitude(square, band, column + 1, row.wrapping_sub(1));
            let mut around =
                2 * (near(1, 0) + near(0, 1)) + near(1, 1) + north_east + near(2, 0) + near(0, 2);
            if let Some(parent) = parent {
                around += 2 * magnitude(square, parent, column / 2, row / 2);
            }
            let at = (band.top + row) * SIDE + band.left + column;
            square[at] = numbers.code(bits, around, square[at]);
        }
    }
}

/// Codes the smooth band: each number as its difference from the prediction of its neighbours,
/// which is the median of west, north, and west + north − north-west.
///
/// Source: Weinberger, Seroussi & Sapiro 2000, *The LOCO-I lossless image compression algorithm*.
pub(crate) fn code_smooth<B: Bits>(bits: &mut B, square: &mut [i64], band: Band) {
    let mut numbers = NumberModel::new();
    let mut before = 0;
    for row in 0..band.rows {
        for column in 0..band.columns {
            let at = |column: usize, row: usize| square[row * SIDE + column];
            let expected = match (column, row) {
                (0, 0) => 0,
                (_, 0) => at(column - 1, 0),
                (0, _) => at(0, row - 1),
                _ => {
                    let (west, north) = (at(column - 1, row), at(column, row - 1));
                    let (low, high) = (west.min(north), west.max(north));
                    (west + north - at(column - 1, row - 1)).clamp(low, high)
                }
            };
            let place = row * SIDE + column;
            let difference = numbers.code(bits, before, square[place] - expected);
            before = 2 * difference.abs();
            square[place] = expected + difference;
        }
    }
}

/// Codes one bit for each node (whether it has a height, or whether it is water), in the context of
/// the four nodes before it.
pub(crate) fn code_mask<B: Bits>(bits: &mut B, mask: &mut [bool]) {
    let mut models = [Model::default(); 16];
    for row in 0..SIDE {
        for column in 0..SIDE {
            let at = |column: usize, row: usize| {
                column < SIDE && row < SIDE && mask[row * SIDE + column]
            };
            let (west, north) = (column.wrapping_sub(1), row.wrapping_sub(1));
            let near = [at(west, row), at(column, north), at(west, north), at(column + 1, north)];
            let class = near.iter().fold(0, |class, &there| 2 * class + usize::from(there));
            let place = row * SIDE + column;
            mask[place] = bits.bit(&mut models[class], u32::from(mask[place])) == 1;
        }
    }
}

#[cfg(all(test, feature = "write"))]
#[path = "coefficients_tests.rs"]
mod tests;
