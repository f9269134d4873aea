//! Several 32-bit floats at a time, written so that compilers use one instruction for each step.

/// The number of nodes that are processed together. Rows of a face are short: most have no more
/// nodes.
pub(crate) const LANES: usize = 4;

/// One number per lane.
pub(crate) type Lanes = [f32; LANES];

/// The number of each lane.
pub(crate) const STEPS: Lanes = [0.0, 1.0, 2.0, 3.0];

/// The addend for distances: 0 for nodes of a row, NaN for the lanes after it. A slice begins as
/// many values in as there are unused lanes.
pub(crate) const AFTER_ROW: [f32; 2 * LANES] =
    [0.0, 0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, f32::NAN];

/// Returns the result of `each` for every lane. `array::from_fn` and `array::map` are not always
/// inlined.
#[inline(always)]
#[expect(
    clippy::inline_always,
    reason = "lanes that are passed through memory take longer than the step"
)]
pub(crate) fn lanes(each: impl Fn(usize) -> f32) -> Lanes {
    [each(0), each(1), each(2), each(3)]
}

/// Returns the smaller of two numbers in each lane. `f32::min` would take four more instructions
/// for its treatment of NaN.
#[inline(always)]
#[expect(
    clippy::inline_always,
    reason = "lanes that are passed through memory take longer than the step"
)]
pub(crate) fn less(a: Lanes, b: Lanes) -> Lanes {
    lanes(|lane| if a[lane] < b[lane] { a[lane] } else { b[lane] })
}
