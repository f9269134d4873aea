//! Ranges of heights that are padded against rounding.

/// The relative padding of heights, of the largest of them and of their range: far more than f64
/// rounding in the cut polygons, far less than a height quantum.
pub(crate) const PAD: f64 = 1e-6;

/// Returns a range of heights, padded so that rounding cannot have made it too narrow.
pub(crate) fn padded([lowest_m, highest_m]: [f64; 2]) -> [f64; 2] {
    let pad_m = PAD * lowest_m.abs().max(highest_m.abs()).max(highest_m - lowest_m);
    [lowest_m - pad_m, highest_m + pad_m]
}
