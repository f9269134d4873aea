//! The exact test on which side of a line a point lies.

use crate::LatticePoint;

/// On which side of a directed line a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// The point lies to the right of the direction of travel (clockwise turn).
    Right,
    /// Exactly on the line.
    On,
    /// The point lies to the left of the direction of travel (counter-clockwise turn).
    Left,
}

/// Twice the signed area of the triangle a, b, c in square lattice steps; positive when
/// counter-clockwise seen from above. Exact for all coordinates below 2^62.
#[must_use]
#[inline]
pub fn cross(a: LatticePoint, b: LatticePoint, c: LatticePoint) -> i128 {
    // Two products of 31-bit factors fit an i64 with their difference; this is the common case
    // (a tile of 256 cells at less than 2^22 steps each) and several times faster than i128.
    const SMALL: i64 = 1 << 31;
    let (abu, abv) = (b.u - a.u, b.v - a.v);
    let (acu, acv) = (c.u - a.u, c.v - a.v);
    if abu.abs() < SMALL && abv.abs() < SMALL && acu.abs() < SMALL && acv.abs() < SMALL {
        i128::from(abu * acv - abv * acu)
    } else {
        i128::from(abu) * i128::from(acv) - i128::from(abv) * i128::from(acu)
    }
}

/// The product of the vectors from `from` to `to` and to `point`, in square lattice steps: positive where these are less than a right angle
/// apart. Exact for all coordinates below 2^62.
#[must_use]
#[inline]
pub fn dot(from: LatticePoint, to: LatticePoint, point: LatticePoint) -> i128 {
    i128::from(to.u - from.u) * i128::from(point.u - from.u)
        + i128::from(to.v - from.v) * i128::from(point.v - from.v)
}

/// On which side of the line from `a` to `b` the point `c` lies, exactly.
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
