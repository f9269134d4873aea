//! Barycentric coordinates along a segment in whole numbers, and the comparison of the exits from a
//! triangle.

use std::cmp::Ordering;

use corniche_geom::{LatticePoint, cross};

use crate::fraction::Fraction;

/// One barycentric coordinate of a triangle along a segment p → q, times twice the triangle's area.
///
/// Let `[a, b, x]` be the orientation of three points ([`cross`]): twice the signed area between
/// them. In a counter-clockwise triangle o, d, c the coordinates of a point x, times twice its
/// area, are orientations:
///
/// ```text
///   o(x) = [d, c, x]     d(x) = [c, o, x]     c(x) = [o, d, x]     o(x) + d(x) + c(x) = [o, d, c] > 0
/// ```
///
/// Along the whole segment a coordinate changes by its rate, for example `o' = o(q) − o(p)`. If the
/// rate is below 0, the segment exits across the edge opposite the corner, at the fraction
/// `o(p) / −o'` of its length: twice the area cancels out. The segment leaves the triangle at the
/// smallest of these exits that is ahead. This is the method of the paper, which measures metres
/// along the segment instead of fractions.
///
/// # Why the orientation of the apex compares the exits
///
/// Let the segment enter across o → d, at a point e in the interior of that edge, with q beyond it.
/// The apex is c.
///
/// ```text
///             c            From e the exits are   o(e) / −o'   across d → c, if o' < 0,
///            / \                                  d(e) / −d'   across c → o, if d' < 0.
///      p ─ ─/─ ─\─ ─► q
///          /     \         o(e) and d(e) are above 0. One of o' and d' is below 0 at least: the three rates add up to 0,
///         o───e───d        and c' is above 0, because the segment comes in there.
/// ```
///
/// 1. The orientation of three points is the determinant of their coordinates, times twice the
///    area. The coordinates of c are 0, 0 and 1. With `o(q) = o(e) + o'`, and each coordinate in
///    the determinant times twice the area:
///    `[o, d, c] · [e, q, c] = o(e) · d(q) − d(e) · o(q) = o(e) · d' − d(e) · o'`.
/// 2. If both rates are below 0, the exit across d → c is the smaller one if
///    `o(e) · −d' < d(e) · −o'`, which means that the right side of 1 is above 0. If only `o'` is
///    below 0, d → c has the only exit, and the right side is above 0, too. If only `d'` is below
///    0, c → o has the only exit, and the right side is below 0.
/// 3. `[o, d, c]` is above 0, and `[e, q, c]` has the sign of `[p, q, c]`, because e is on the
///    segment before q.
///
/// So the segment leaves across d → c if c is on its left, across c → o if c is on its right, and
/// through c, where both exits coincide, if c is on it. By 1 this comparison holds from any point
/// of the line if both rates are below 0. And q is before an exit if the coordinate is still above
/// 0 there.
///
/// Source: Vaaraniemi, Treib & Westermann 2011, *High-Quality Cartographic Roads on High-Resolution
/// DEMs*, section 6.1. Changed: there is no division and no floating point; where the paper
/// compares three numbers, two signs decide.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Barycentric {
    segment: [LatticePoint; 2],
    /// The edge opposite the corner of this coordinate; the triangle is on its left.
    edge: [LatticePoint; 2],
}

impl Barycentric {
    /// Creates the coordinate that is 0 on `edge`, along `segment`.
    #[inline]
    pub(crate) fn new(segment: [LatticePoint; 2], edge: [LatticePoint; 2]) -> Self {
        Self { segment, edge }
    }

    /// Returns the coordinate of a point.
    pub(crate) fn at(&self, point: LatticePoint) -> i128 {
        cross(self.edge[0], self.edge[1], point)
    }

    /// Returns the change of the coordinate from the segment's start to its end: below 0 if the
    /// segment exits across the edge, above 0 if it enters.
    pub(crate) fn rate(&self) -> i128 {
        self.at(self.segment[1]) - self.at(self.segment[0])
    }

    /// Returns the position along the segment where the coordinate is 0: the exit across the edge,
    /// or the entry. The rate must not be 0.
    pub(crate) fn zero(&self) -> Fraction {
        Fraction::new(self.at(self.segment[0]), -self.rate())
    }

    /// Returns the sign of the coordinate at the segment's end. For an exit: `Greater` if the end
    /// is before it, `Less` if the end is beyond it.
    #[inline]
    pub(crate) fn sign_at_end(&self) -> Ordering {
        turn(self.edge[0], self.edge[1], self.segment[1])
    }
}

/// Returns on which side of the line from `a` to `b` the point `c` is, exactly: `Greater` on its
/// left. This is the sign of [`cross`], without computing the number: for a tile's own triangles
/// products fit in 64 bits.
#[inline]
pub(crate) fn turn(a: LatticePoint, b: LatticePoint, c: LatticePoint) -> Ordering {
    const SMALL: i64 = 1 << 31;
    let (abu, abv) = (b.u - a.u, b.v - a.v);
    let (acu, acv) = (c.u - a.u, c.v - a.v);
    if abu.abs() | abv.abs() | acu.abs() | acv.abs() < SMALL {
        (abu * acv).cmp(&(abv * acu))
    } else {
        cross(a, b, c).cmp(&0)
    }
}

#[cfg(test)]
#[path = "barycentric_tests.rs"]
mod tests;
