//! The side of a line is exact, whatever arithmetic computes it.

use super::*;
use proptest::prelude::*;

fn point(range: std::ops::Range<i64>) -> impl Strategy<Value = LatticePoint> {
    (range.clone(), range).prop_map(|(u, v)| LatticePoint::new(u, v))
}

proptest! {
    /// The fast path gives the same number as 128-bit arithmetic, on both sides of its limit.
    #[test]
    fn short_path_equals_wide_arithmetic(
        a in point(-(1 << 33)..1 << 33), b in point(-(1 << 33)..1 << 33), c in point(-(1 << 33)..1 << 33),
    ) {
        let wide = |p: LatticePoint| (i128::from(p.u - a.u), i128::from(p.v - a.v));
        let ((bu, bv), (cu, cv)) = (wide(b), wide(c));
        prop_assert_eq!(cross(a, b, c), bu * cv - bv * cu);
    }

    /// Swapping two corners reverses the triangle.
    #[test]
    fn exchanging_two_corners_changes_the_sign(a in point(-1000..1000), b in point(-1000..1000), c in point(-1000..1000)) {
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
