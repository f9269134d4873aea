//! Places and numbers on straight lines.

pub(crate) use corniche_geom::along;
use corniche_geom::{LatticeBounds, LatticePoint};

/// Returns the number at a share of the way between two. At shares 0 and 1, it is exactly one of
/// them.
pub(crate) fn mix(from: f64, to: f64, share: f64) -> f64 {
    match share {
        ..=0.0 => from,
        1.0.. => to,
        _ => from + share * (to - from),
    }
}

/// Returns the place in the middle.
pub(crate) fn middle(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|axis| f64::midpoint(from[axis], to[axis]))
}

/// Returns the vector from one place to another.
pub(crate) fn vector(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

/// Returns the distance between two places.
pub(crate) fn distance(from: [f64; 2], to: [f64; 2]) -> f64 {
    (to[0] - from[0]).hypot(to[1] - from[1])
}

/// Whether a place on the lattice is on the western, eastern, southern and northern side of a
/// rectangle.
pub(crate) fn sides([u, v]: [f64; 2], bounds: &LatticeBounds) -> [bool; 4] {
    let is_at = |here: f64, line: i64| (here - line as f64).abs() < f64::MIN_POSITIVE;
    [is_at(u, bounds.min.u), is_at(u, bounds.max.u), is_at(v, bounds.min.v), is_at(v, bounds.max.v)]
}

/// Returns twice the area of a triangle, positive if it is counter-clockwise.
pub(crate) fn doubled_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Returns the vector from one point of the lattice to another, in steps.
pub(crate) fn steps_between(from: LatticePoint, to: LatticePoint) -> [f64; 2] {
    [(to.u - from.u) as f64, (to.v - from.v) as f64]
}

/// Returns the point of the lattice nearest to a place in steps.
pub(crate) fn nearest_point(at: [f64; 2]) -> LatticePoint {
    let [u, v] = at.map(|steps| steps.round() as i64);
    LatticePoint::new(u, v)
}

/// Returns the place on the way from the origin to `run` that is nearest to `off`, as a share of
/// the way, and its distance.
pub(crate) fn nearest(run: [f64; 2], off: [f64; 2]) -> [f64; 2] {
    let share = (run[0] * off[0] + run[1] * off[1]) / (run[0] * run[0] + run[1] * run[1]);
    let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
    [share, (off[0] - share * run[0]).hypot(off[1] - share * run[1])]
}
