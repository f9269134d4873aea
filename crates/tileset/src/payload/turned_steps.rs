//! Steps from one point of a line to the next as range-coded bits.
//!
//! A road or an outline mostly continues in its previous direction, so a step is turned and
//! mirrored until the step before it points between east and north-east:
//!
//! ```text
//!        across                    p is the step before, in the first octant; the next step is coded as
//!          │      ⋰ ╱ q            how far it goes along (mostly on, sometimes back), and then how far
//!          │   ⋰ ╱ ╱               across, on which side: both in contexts of the length and the slope of p.
//!          │⋰  ╱╱──── p
//!          └──────────── along
//! ```

use crate::payload::{
    magnitudes::Magnitudes,
    range_coder::{Bits, Model},
};

/// The number of possible counts of binary digits of a step: 0 to 32, and larger steps count as 32.
const LENGTHS: usize = 33;
/// The number of slope classes of the step before: quarters, and one for no step before.
const SLOPES: usize = 5;
/// The number of lengths of a step along that the contexts of the step across distinguish.
const ALONG_LENGTHS: usize = 20;

/// The number of binary digits of a number.
pub(crate) fn length(number: i64) -> usize {
    (u64::BITS - number.unsigned_abs().leading_zeros()) as usize
}

/// The state of a coder of steps.
#[derive(Default)]
pub(crate) struct StepCoder {
    along: Magnitudes<LENGTHS, SLOPES>,
    across: Magnitudes<{ ALONG_LENGTHS * SLOPES }, LENGTHS>,
    goes_back: [[Model; 4]; SLOPES],
    is_across_south: [[[Model; 7]; 2]; SLOPES],
}

impl StepCoder {
    /// Codes a step that follows the step `before`, if there was one.
    pub(crate) fn code<B: Bits>(
        &mut self,
        bits: &mut B,
        before: Option<[i64; 2]>,
        step: [i64; 2],
    ) -> [i64; 2] {
        let before = before.unwrap_or_default();
        let [west, south] = before.map(|step| step < 0);
        let is_steep = before[1].abs() > before[0].abs();
        let mirror = |[x, y]: [i64; 2]| {
            [if west { x.wrapping_neg() } else { x }, if south { y.wrapping_neg() } else { y }]
        };
        let swap = |[x, y]: [i64; 2]| if is_steep { [y, x] } else { [x, y] };
        let [long, short] = swap(before.map(i64::abs));
        let long_length = length(long);
        let slope = if long == 0 { 0 } else { 1 + (4 * short / long).min(3) as usize };
        let [along, across] = swap(mirror(step));

        let along_size =
            self.along.code_magnitude(bits, [long_length, slope], along.unsigned_abs()) as i64;
        let along_length = length(along_size);
        let across_contexts = [along_length.min(ALONG_LENGTHS - 1) * SLOPES + slope, long_length];
        let across_size =
            self.across.code_magnitude(bits, across_contexts, across.unsigned_abs()) as i64;
        let mut goes_back = 0;
        if along_size != 0 {
            let size = (along_length + 2).saturating_sub(long_length).min(3);
            goes_back = bits.bit(&mut self.goes_back[slope][size], u32::from(along < 0));
        }
        let mut is_across_south = 0;
        if across_size != 0 {
            let size = (length(across_size) + 3).saturating_sub(along_length).min(6);
            let model = &mut self.is_across_south[slope][goes_back as usize][size];
            is_across_south = bits.bit(model, u32::from(across < 0));
        }
        let signed = |size: i64, is_negative: u32| if is_negative == 1 { -size } else { size };
        mirror(swap([signed(along_size, goes_back), signed(across_size, is_across_south)]))
    }
}
