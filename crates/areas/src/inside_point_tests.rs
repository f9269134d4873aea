//! The place inside an area is inside it, by another rule.

use corniche_geom::{LatticeBounds, LatticeRegion};
use proptest::prelude::*;

use super::*;
use crate::{OutlineWay, assemble};

fn square(from: i64, to: i64) -> Polygon {
    let [min, max] = [from, to].map(|at| LatticePoint::new(at, at));
    Polygon::rectangle(LatticeBounds { min, max }).unwrap()
}

#[test]
fn the_largest_polygon_counts_and_of_equal_ones_the_first() {
    assert_eq!(inside_point(&[]), None);
    let [small, first, second] = [square(0, 4), square(10, 20), square(30, 40)];
    let point = |polygons: &[&Polygon]| {
        inside_point(&polygons.iter().copied().cloned().collect::<Vec<_>>()).unwrap()
    };
    assert_eq!(point(&[&small, &first, &second]), LatticePoint::new(15, 15));
    assert_eq!(point(&[&small, &second, &first]), LatticePoint::new(35, 35));
}

/// The middle of the box around a ring with a hole is in the hole.
#[test]
fn the_place_is_beside_holes_and_in_the_broader_arm() {
    let ring = |from: i64, to: i64, east: i64| {
        [[from, from], [east, from], [east, to], [from, to], [from, from]]
            .map(|[u, v]| LatticePoint::new(u, v))
    };
    let rings = [ring(0, 100, 120), ring(40, 60, 60)];
    let ways = rings.each_ref().map(|points| OutlineWay { points });
    let polygons = assemble(&ways).unwrap().polygons;
    assert_eq!(inside_point(&polygons), Some(LatticePoint::new(90, 50)));
}

proptest! {
    /// Stars with any corners: the place is in the region of the same outline, which has another
    /// rule for what is inside.
    #[test]
    fn the_place_is_inside(
        center in [-1_000_000_i64..1_000_000, -1_000_000_i64..1_000_000],
        radii in prop::collection::vec(100_i64..100_000, 4..40),
    ) {
        let corner = |(number, radius): (usize, &i64)| {
            let angle = number as f64 / radii.len() as f64 * std::f64::consts::TAU;
            let [u, v] = [angle.cos(), angle.sin()].map(|along| (along * *radius as f64) as i64);
            LatticePoint::new(center[0] + u, center[1] + v)
        };
        let mut points: Vec<LatticePoint> = radii.iter().enumerate().map(corner).collect();
        points.push(points[0]);
        let Ok(assembled) = assemble(&[OutlineWay { points: &points }]) else { return Ok(()) };
        let found = inside_point(&assembled.polygons).unwrap();
        let region = LatticeRegion::new(&[vec![points]]).unwrap();
        let near = [-1, 0, 1].map(|along| LatticePoint::new(found.u + along, found.v));
        prop_assert!(near.into_iter().any(|point| region.contains(point)), "{found:?}");
        prop_assert_eq!(inside_point(&assembled.polygons), Some(found));
    }
}
