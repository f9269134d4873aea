//! How high the ground is along segments, as range-coded bits.

use crate::payload::magnitudes::{Magnitudes, half_octave};
use crate::payload::range_coder::Bits;

/// Half-octaves of the number of the same kind at the segment before.
const BEFORE: usize = 48;
/// Binary digits of a segment's length.
const LENGTHS: usize = 33;

/// What a coder knows of the ground ranges of a class.
pub(crate) struct RangeCoder {
    lows: Magnitudes<BEFORE, LENGTHS>,
    spans: Magnitudes<BEFORE, LENGTHS>,
    low_q: i64,
    low_step: i64,
    span: u64,
}

impl RangeCoder {
    pub(crate) fn new() -> Self {
        Self { lows: Magnitudes::new(), spans: Magnitudes::new(), low_q: 0, low_step: 0, span: 0 }
    }

    /// Codes the lowest ground of the next segment and how much higher its highest is, in height steps; `length` is the number of binary
    /// digits of the segment's length. A reader's numbers do not matter; a writer's that have no code come back otherwise.
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
