//! The part of a segment or ray inside an axis-aligned box, so that only that part is processed.

/// The shares of the way, from 0 to `most`, between which a segment or ray may be in a box, given
/// by the lowest and highest coordinate along each axis. The second share is below the first if it
/// is outside.
pub(crate) fn shares_in<const N: usize>(
    from: [f64; N],
    way: [f64; N],
    around: [[f64; 2]; N],
    most: f64,
) -> [f64; 2] {
    let mut shares = [0.0_f64, most];
    for ((start, [low, high]), step) in from.into_iter().zip(around).zip(way) {
        let [to_low, to_high] = [low - start, high - start];
        if step == 0.0 {
            if to_low > 0.0 || to_high < 0.0 {
                return [1.0, 0.0];
            }
            continue;
        }
        let (enters, leaves) = (to_low / step, to_high / step);
        shares[0] = shares[0].max(enters.min(leaves));
        shares[1] = shares[1].min(enters.max(leaves));
    }
    shares
}
