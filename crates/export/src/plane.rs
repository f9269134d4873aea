//! Places and numbers on straight lines.

pub(crate) use corniche_geom::along;

/// The number at a share of the way between two, of which one counts alone at its own place.
pub(crate) fn mix(from: f64, to: f64, share: f64) -> f64 {
    match share {
        ..=0.0 => from,
        1.0.. => to,
        _ => from + share * (to - from),
    }
}

/// The place in the middle.
pub(crate) fn middle(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|axis| f64::midpoint(from[axis], to[axis]))
}

/// From one place to another.
pub(crate) fn vector(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

/// Which place on the way from the origin to `run` is nearest to `off`, as a share of it, and how far that is.
pub(crate) fn nearest(run: [f64; 2], off: [f64; 2]) -> [f64; 2] {
    let share = (run[0] * off[0] + run[1] * off[1]) / (run[0] * run[0] + run[1] * run[1]);
    let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
    [share, (off[0] - share * run[0]).hypot(off[1] - share * run[1])]
}
