//! Crossings of a way with itself are the same as those found with integers.

use corniche_geom::{MAX_LATTICE_STEPS, Side, side};
use proptest::prelude::*;

use super::*;

#[track_caller]
fn check_crossings(points: &[(i64, i64)], expected: u32) {
    let points: Vec<LatticePoint> = points.iter().map(|&(u, v)| LatticePoint::new(u, v)).collect();
    assert_eq!(self_crossings(&points), expected);
}

#[test]
fn counts_crossings_but_not_touches() {
    check_crossings(&[(0, 0), (10, 10), (10, 0), (0, 10)], 1);
    check_crossings(&[(0, 0), (10, 0), (10, 10), (0, 10), (0, 0)], 0);
    check_crossings(&[(0, 0), (10, 0), (0, 0)], 0);
    // The lines are a loop through one of its own points, and a T into the middle of a segment.
    check_crossings(&[(0, 0), (10, 0), (15, 5), (20, 0), (10, 0), (10, -9)], 0);
    check_crossings(&[(0, 0), (10, 0), (10, 5), (5, 5), (5, 0)], 0);
    // The line is a five-pointed star.
    check_crossings(&[(0, 100), (59, -81), (-95, 31), (95, 31), (-59, -81), (0, 100)], 5);
    check_crossings(&[(5, -5), (5, 5), (0, 0), (10, 0)], 1);
}

/// Whether the ends of `other` are strictly on different sides of the line through `segment`,
/// computed with integers.
fn straddles(segment: [LatticePoint; 2], other: [LatticePoint; 2]) -> bool {
    let [from, to] = other.map(|end| side(segment[0], segment[1], end));
    from != Side::On && to != Side::On && from != to
}

/// Generates points close together, so that many are on one line, around a position anywhere on the
/// lattice.
fn points() -> impl Strategy<Value = [LatticePoint; 4]> {
    let far = MAX_LATTICE_STEPS - 200;
    let at = (-far..far, -far..far, prop::sample::select(vec![1_i64, 7, 1 << 30]));
    let offsets = prop::array::uniform4((-6_i64..7, -6_i64..7));
    (at, offsets).prop_map(move |((u, v, scale), offsets)| {
        offsets.map(|(du, dv)| {
            let stay = |at: i64| at.clamp(-far, far);
            LatticePoint::new(stay(u + du * scale), stay(v + dv * scale))
        })
    })
}

proptest! {
    /// Two segments cross if the exact integer test says so, anywhere on the lattice.
    #[test]
    fn crossings_are_those_of_whole_numbers([a, b, c, d] in points()) {
        prop_assume!(a != b && c != d);
        let expected = straddles([a, b], [c, d]) && straddles([c, d], [a, b]);
        prop_assert_eq!(cross_inside([a, b], [c, d]), expected);
    }
}
