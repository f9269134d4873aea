//! Several 32-bit floats at a time, written so that compilers make one instruction of each step.

/// Nodes looked at together. Rows of a face are short: most have no more.
pub(crate) const LANES: usize = 4;

/// One number for each lane.
pub(crate) type Lanes = [f32; LANES];

/// The number of each lane.
pub(crate) const STEPS: Lanes = [0.0, 1.0, 2.0, 3.0];

/// Added to distances: nothing to those of a row, NaN to those of lanes after it. Starts as many lanes in as are not used.
pub(crate) const AFTER_ROW: [f32; 2 * LANES] =
    [0.0, 0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, f32::NAN];

/// What `each` gives for every lane. `array::from_fn` and `array::map` are not always inlined.
#[inline(always)]
#[expect(clippy::inline_always, reason = "lanes that go through memory take longer than the step")]
pub(crate) fn lanes(each: impl Fn(usize) -> f32) -> Lanes {
    [each(0), each(1), each(2), each(3)]
}

/// The smaller of two numbers in each lane. Not `f32::min`, which costs four instructions more to say what NaN is.
#[inline(always)]
#[expect(clippy::inline_always, reason = "lanes that go through memory take longer than the step")]
pub(crate) fn less(a: Lanes, b: Lanes) -> Lanes {
    lanes(|lane| if a[lane] < b[lane] { a[lane] } else { b[lane] })
}
