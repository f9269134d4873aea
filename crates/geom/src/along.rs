//! Positions on straight lines.

/// Returns the position at a fraction of the way.
#[must_use]
pub fn along<const N: usize>(from: [f64; N], to: [f64; N], share: f64) -> [f64; N] {
    std::array::from_fn(|axis| from[axis] + (to[axis] - from[axis]) * share)
}
