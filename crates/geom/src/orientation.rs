use crate::LatticePoint;

/// On which side of a directed line a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// To the right of the direction of travel (clockwise turn).
    Right,
    /// Exactly on the line.
    On,
    /// To the left of the direction of travel (counter-clockwise turn).
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
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point(range: std::ops::Range<i64>) -> impl Strategy<Value = LatticePoint> {
        (range.clone(), range).prop_map(|(u, v)| LatticePoint::new(u, v))
    }

    proptest! {
        /// The short path gives the same number as 128-bit arithmetic, on both sides of its limit.
        #[test]
        fn short_path_equals_wide_arithmetic(
            a in point(-(1 << 33)..1 << 33), b in point(-(1 << 33)..1 << 33), c in point(-(1 << 33)..1 << 33),
        ) {
            let wide = |p: LatticePoint| (i128::from(p.u - a.u), i128::from(p.v - a.v));
            let ((bu, bv), (cu, cv)) = (wide(b), wide(c));
            prop_assert_eq!(cross(a, b, c), bu * cv - bv * cu);
        }

        /// Swapping two corners turns the triangle over.
        #[test]
        fn is_antisymmetric(a in point(-1000..1000), b in point(-1000..1000), c in point(-1000..1000)) {
            prop_assert_eq!(cross(a, b, c), -cross(b, a, c));
        }
    }

    #[test]
    fn left_is_north_of_an_eastward_line() {
        let (a, b) = (LatticePoint::new(0, 0), LatticePoint::new(10, 0));
        assert_eq!(side(a, b, LatticePoint::new(5, 1)), Side::Left);
        assert_eq!(side(a, b, LatticePoint::new(5, -1)), Side::Right);
        assert_eq!(side(a, b, LatticePoint::new(50, 0)), Side::On);
    }
}
