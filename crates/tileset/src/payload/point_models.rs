//! The models of points that the coders of lines and of rings share.

use crate::payload::{
    damage::{Damage, Result},
    magnitudes::Magnitudes,
    range_coder::{Bits, Model},
    turned_steps::StepCoder,
};

/// What a coder has learned of points, of the steps between them and of references to earlier ones.
#[derive(Default)]
pub(crate) struct PointModels {
    is_known: [[Model; 2]; 3],
    back: Magnitudes<1, 1>,
    starts: [Magnitudes<1, 1>; 2],
    steps: StepCoder,
    /// Whether a point lies beside the nodes of its grid, and how far.
    pub is_beside: Model,
    pub beside: [Magnitudes<1, 1>; 2],
}

impl PointModels {
    /// Codes whether a point is one of `count` earlier ones, and its number among them.
    pub(crate) fn code_known<B: Bits>(
        &mut self,
        bits: &mut B,
        (place, was): (usize, bool),
        asked: Option<usize>,
        count: usize,
    ) -> Result<Option<usize>> {
        let model = &mut self.is_known[place][usize::from(was)];
        if bits.bit(model, u32::from(asked.is_some())) == 0 {
            return Ok(None);
        }
        let back = asked.map_or(0, |at| (count - 1 - at) as u64);
        let back = self.back.code_magnitude(bits, [0; 2], back);
        let number = (count as u64).checked_sub(back + 1).map(|number| number as usize);
        let unknown = Damage::Invalid("a reference to a point that does not exist");
        number.map(Some).ok_or(unknown)
    }

    /// Codes the step to a new point, which follows the step `before`, if there was one.
    pub(crate) fn code_step<B: Bits>(
        &mut self,
        bits: &mut B,
        is_first: bool,
        before: Option<[i64; 2]>,
        step: [i64; 2],
    ) -> [i64; 2] {
        if !is_first {
            return self.steps.code(bits, before, step);
        }
        let [east, north] = &mut self.starts;
        [east.code(bits, [0; 2], step[0]), north.code(bits, [0; 2], step[1])]
    }
}
