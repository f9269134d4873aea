//! Codes the height ranges of the ground along segments as range-coded bits.

use crate::payload::{
    magnitudes::{Magnitudes, half_octave},
    range_coder::Bits,
};

/// Number of half-octaves of the number of the same kind at the segment before.
const BEFORE: usize = 48;
/// Number of possible counts of binary digits of a segment's length.
const LENGTHS: usize = 33;

/// The state of a coder of the ground ranges of a class.
#[derive(Default)]
pub(crate) struct RangeCoder {
    lows: Magnitudes<BEFORE, LENGTHS>,
    spans: Magnitudes<BEFORE, LENGTHS>,
    low_q: i64,
    low_step: i64,
    span: u64,
}

impl RangeCoder {
    /// Codes the lowest ground of the next segment, and the highest minus the lowest, in height
    /// steps; `length` is the number of binary digits of the segment's length. A reader's numbers
    /// are ignored; if a writer's numbers have no code, the returned numbers differ from them.
    pub(crate) fn code<B: Bits>(
        &mut self,
        bits: &mut B,
        length: usize,
        (low_q, span): (i64, u64),
    ) -> (i64, u64) {
        let step = low_q.wrapping_sub(self.low_q);
        let contexts = [half_octave(self.low_step.unsigned_abs()), length];
        self.low_step = self.lows.code(bits, contexts, step);
        self.low_q = self.low_q.wrapping_add(self.low_step);
        self.span = self.spans.code_magnitude(bits, [half_octave(self.span), length], span);
        (self.low_q, self.span)
    }
}
