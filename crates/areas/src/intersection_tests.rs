//! The parts inside and outside a region add up to the whole, and are valid polygons.

use proptest::prelude::*;

use super::*;
use crate::{OutlineError, OutlineWay, assemble, surrounded};

fn ring(corners: &[[i64; 2]], step: i64) -> Vec<LatticePoint> {
    corners.iter().map(|&[u, v]| LatticePoint::new(u * step, v * step)).collect()
}

fn square([west, south]: [i64; 2], side: i64, step: i64) -> Vec<LatticePoint> {
    let (east, north) = (west + side, south + side);
    ring(&[[west, south], [east, south], [east, north], [west, north]], step)
}

fn polygon(ring: &[LatticePoint]) -> Vec<Polygon> {
    let closed: Vec<LatticePoint> = ring.iter().chain(ring.first()).copied().collect();
    assemble(&[OutlineWay { points: &closed }]).unwrap().polygons
}

fn doubled_area(polygons: &[Polygon]) -> i128 {
    polygons.iter().map(Polygon::doubled_area).sum()
}

#[test]
fn squares_that_overlap_have_a_square_in_common() {
    let found = intersection(
        &polygon(&square([0, 0], 10, 4)),
        std::iter::once(square([6, 7], 10, 4).as_slice()),
        4,
    );
    let expected = polygon(&ring(&[[6, 7], [10, 7], [10, 10], [6, 10]], 4));
    assert_eq!(found.unwrap(), expected);
}

#[test]
fn a_region_of_polygons_that_overlap_is_their_union_and_holes_are_left_out() {
    let mut hole = square([2, 2], 3, 1);
    hole.reverse();
    let region = [square([0, 0], 8, 1), hole, square([4, 4], 8, 1)];
    let found =
        intersection(&polygon(&square([-5, -5], 40, 1)), region.iter().map(Vec::as_slice), 1)
            .unwrap();
    // The numbers are 64 + 64 - 16 - (9 - 1): one cell of the hole is in the second square.
    assert_eq!(doubled_area(&found), 2 * (64 + 64 - 16 - 8));
}

#[test]
fn where_two_holes_lie_over_each_other_nothing_is_inside() {
    let mut holes = [square([2, 2], 4, 1), square([4, 4], 4, 1)];
    for hole in &mut holes {
        hole.reverse();
    }
    let region = [square([0, 0], 10, 1), holes[0].clone(), holes[1].clone()];
    let found =
        intersection(&polygon(&square([-5, -5], 40, 1)), region.iter().map(Vec::as_slice), 1)
            .unwrap();
    assert_eq!(doubled_area(&found), 2 * (100 - 16 - 16 + 4));
}

#[test]
fn what_lies_beside_the_region_is_nothing() {
    let found = intersection(
        &polygon(&square([0, 0], 10, 1)),
        std::iter::once(square([20, 0], 5, 1).as_slice()),
        1,
    );
    assert_eq!(found.unwrap(), []);
}

#[test]
fn more_steps_than_can_be_counted_are_refused() {
    let far = square([0, 0], i64::from(i32::MAX) + 5, 1);
    let found = intersection(&polygon(&far), std::iter::once(square([0, 0], 5, 1).as_slice()), 1);
    assert!(matches!(found, Err(OutlineError::TooIntricate)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Distant points of the region do not affect the result near the polygon.
    #[test]
    fn a_ring_without_its_far_points_winds_as_often(
        corners in prop::collection::vec([-60_i64..60, -60_i64..60], 3..30),
        [west, south] in [-50_i64..40, -50_i64..40],
        side in 0_i64..12,
    ) {
        let ring = ring(&corners, 1);
        let [min, max] = [[west, south], [west + side, south + side]].map(|[u, v]| LatticePoint::new(u, v));
        let fewer = without_far_points(&ring, &LatticeBounds { min, max });
        let winding = |ring: &[LatticePoint], [u, v]: [f64; 2]| -> i32 {
            let next = ring.iter().cycle().skip(1);
            let crossing = |(a, b): (&LatticePoint, &LatticePoint)| {
                let [au, av, bu, bv] = [a.u, a.v, b.u, b.v].map(|part| part as f64);
                if (av > v) == (bv > v) || u >= au + (v - av) / (bv - av) * (bu - au) { 0 } else if bv > av { 1 } else { -1 }
            };
            ring.iter().zip(next).map(crossing).sum()
        };
        for du in 0..side {
            for dv in 0..side {
                // No test position is on a segment, because segments have integer ends below 60.
                let place = [(west + du) as f64 + 0.500_137, (south + dv) as f64 + 0.500_071];
                prop_assert_eq!(winding(&ring, place), winding(&fewer, place));
            }
        }
    }

    /// The parts inside and outside a triangle add up to the whole, except for rounding at each
    /// crossing.
    #[test]
    fn inside_and_outside_are_the_whole(
        corners in prop::collection::vec([-60_i64..60, -60_i64..60], 3..9),
        triangle in prop::array::uniform3([-60_i64..60, -60_i64..60]),
        step in prop::sample::select(vec![1_i64, 8]),
    ) {
        // Rounding the crossings of a sliver need not end; such outlines are reported as lost.
        let whole = surrounded(&[&ring(&corners, step)], step);
        prop_assume!(!matches!(whole, Err(OutlineError::TooIntricate)));
        let whole = whole.unwrap();
        let mut triangle = ring(&triangle, step);
        if corniche_geom::cross(triangle[0], triangle[1], triangle[2]) < 0 {
            triangle.reverse();
        }
        let mut hole = triangle.clone();
        hole.reverse();
        let around = square([-1000, -1000], 2000, step);
        let inside = intersection(&whole, std::iter::once(triangle.as_slice()), step).unwrap();
        let outside =
            intersection(&whole, [around.as_slice(), hole.as_slice()].into_iter(), step).unwrap();
        let off = (doubled_area(&inside) + doubled_area(&outside) - doubled_area(&whole)).abs();
        // Each of at most 3 × 9 crossings moves two edges of at most 170 steps by at most a step.
        prop_assert!(off <= i128::from(step * step) * 2 * 27 * 170, "{off}");
        for polygon in inside.iter().chain(&outside) {
            prop_assert!(polygon.doubled_area() > 0);
            for (number, ring) in polygon.rings().enumerate() {
                let different: std::collections::BTreeSet<_> = ring.points().iter().collect();
                prop_assert_eq!(different.len(), ring.points().len());
                prop_assert_eq!(ring.doubled_area() > 0, number == 0);
                prop_assert!(ring.points().iter().all(|p| p.u % step == 0 && p.v % step == 0));
            }
        }
    }
}
