//! The exact test of the side of a line on which a point is.

use crate::LatticePoint;

/// The side of a directed line on which a point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// The point is to the right of the direction of travel (clockwise turn).
    Right,
    /// The point is exactly on the line.
    On,
    /// The point is to the left of the direction of travel (counter-clockwise turn).
    Left,
}

/// Twice the signed area of the triangle a, b, c in square lattice steps; positive if
/// counter-clockwise seen from above. Exact for all coordinates below 2^62.
#[must_use]
#[inline]
pub fn cross(a: LatticePoint, b: LatticePoint, c: LatticePoint) -> i128 {
    // Two products of 31-bit factors and their difference fit in an i64; this is the common case (a
    // tile of 256 cells of less than 2^22 steps each), and is several times faster than i128.
    const SMALL: i64 = 1 << 31;
    let (abu, abv) = (b.u - a.u, b.v - a.v);
    let (acu, acv) = (c.u - a.u, c.v - a.v);
    if abu.abs() < SMALL && abv.abs() < SMALL && acu.abs() < SMALL && acv.abs() < SMALL {
        i128::from(abu * acv - abv * acu)
    } else {
        i128::from(abu) * i128::from(acv) - i128::from(abv) * i128::from(acu)
    }
}

/// The dot product of the vectors from `from` to `to` and to `point`, in square lattice steps:
/// positive if the angle between them is less than a right angle. Exact for all coordinates below
/// 2^62.
#[must_use]
#[inline]
pub fn dot(from: LatticePoint, to: LatticePoint, point: LatticePoint) -> i128 {
    i128::from(to.u - from.u) * i128::from(point.u - from.u)
        + i128::from(to.v - from.v) * i128::from(point.v - from.v)
}

/// The side of the line from `a` to `b` on which the point `c` is, exactly.
#[must_use]
#[inline]
pub fn side(a: LatticePoint, b: LatticePoint, c: LatticePoint) -> Side {
    match cross(a, b, c) {
        0 => Side::On,
        positive if positive > 0 => Side::Left,
        _ => Side::Right,
    }
}

#[cfg(test)]
#[path = "orientation_tests.rs"]
mod tests;
