//! Codes heights, each as its difference from a prediction by the vertices before it.

use crate::payload::{
    connectivity::Reached,
    damage::{Damage, Result},
    magnitudes::{Magnitudes, half_octave},
    range_coder::Bits,
};

/// Numbers of contexts: half-octaves of the differences at the gate; height differences at the gate
/// combined with its length.
const BY_RESIDUALS: usize = 40;
const BY_GATE: usize = 64;

/// Codes the heights of all vertices, in the order of the walk. A writer passes the heights, a
/// reader zeros.
pub(crate) fn code_heights<B: Bits>(
    bits: &mut B,
    at: &[[u16; 2]],
    order: &[Reached],
    heights: &mut [i32],
) -> Result<()> {
    let mut numbers = Magnitudes::<BY_RESIDUALS, BY_GATE>::default();
    let mut sizes = vec![0_u32; heights.len()];
    let mut previous = 0_i32;
    for reached in order {
        let vertex = reached.vertex as usize;
        let (guess, contexts) = expect(reached, at, heights, &sizes, previous);
        let wanted = i64::from(heights[vertex]) - i64::from(guess);
        let residual = numbers.code(bits, contexts, wanted);
        let height = i32::try_from(i64::from(guess) + residual);
        previous = height.map_err(|_| Damage::Invalid("a height"))?;
        heights[vertex] = previous;
        sizes[vertex] = residual.unsigned_abs().min(u64::from(u32::MAX)) as u32;
    }
    Ok(())
}

/// Predicts the height at a vertex, and returns the contexts of the difference.
///
/// The prediction is halfway between the middle of the gate and the parallelogram over the triangle
/// below it, which alone overshoots on rough ground.
fn expect(
    reached: &Reached,
    at: &[[u16; 2]],
    heights: &[i32],
    sizes: &[u32],
    previous: i32,
) -> (i32, [usize; 2]) {
    let Reached { vertex, gate } = *reached;
    if gate == [vertex; 3] {
        return (previous, [BY_RESIDUALS - 1, BY_GATE - 1]);
    }
    let corners = gate.map(|corner| corner as usize);
    let [a, b, d] = corners.map(|corner| i64::from(heights[corner]));
    // (3a + 3b − 2d) / 4, rounded down.
    let guess = (3 * (a + b) - 2 * d).div_euclid(4);
    let guess = guess.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32;
    let around: u64 = corners.iter().map(|&corner| u64::from(sizes[corner])).sum();
    let spread = a.max(b).max(d) - a.min(b).min(d);
    // The square of the distance from the gate's middle, in half cells.
    let [[ac, ar], [bc, br], [vc, vr]] =
        [corners[0], corners[1], vertex as usize].map(|corner| at[corner].map(i64::from));
    let (across, along) = (2 * vc - ac - bc, 2 * vr - ar - br);
    let distance = half_octave((across * across + along * along).unsigned_abs()) / 4;
    let by_gate = (half_octave(spread.unsigned_abs()) / 3).min(7) + 8 * distance.min(6);
    (guess, [half_octave(around), by_gate])
}
