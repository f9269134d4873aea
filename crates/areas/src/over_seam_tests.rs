//! A polygon across the end of a map is cut there, including its hole.

use super::*;
use crate::{OutlineWay, assemble};

fn polygon(rings: &[Vec<LatticePoint>]) -> Polygon {
    let closed: Vec<Vec<LatticePoint>> =
        rings.iter().map(|ring| ring.iter().chain(ring.first()).copied().collect()).collect();
    let ways: Vec<OutlineWay<'_>> = closed.iter().map(|points| OutlineWay { points }).collect();
    let [polygon] = <[Polygon; 1]>::try_from(assemble(&ways).unwrap().polygons).unwrap();
    polygon
}

fn square([west, east]: [i64; 2], half: i64) -> Vec<LatticePoint> {
    let corners = [[west, -half], [east, -half], [east, half], [west, half]];
    corners.map(|[u, v]| LatticePoint::new(u, v)).to_vec()
}

#[test]
fn a_polygon_over_the_end_of_the_map_is_cut_there() {
    let seam = Seam::new(0.0, 360.0);
    // The polygon is from 170 to −170 with a hole from 178 to −175; each point is on the map by
    // itself.
    let mut rings = vec![square([170, -170], 10), square([178, -175], 3)];
    unroll_rings(&mut rings, seam);
    assert_eq!(rings, [square([170, 190], 10), square([178, 185], 3)]);
    let parts = split_polygon(polygon(&rings), seam).unwrap();
    let areas: Vec<i128> = parts.iter().map(Polygon::doubled_area).collect();
    assert_eq!(areas, [2 * (10 * 20 - 2 * 6), 2 * (10 * 20 - 5 * 6)]);
    let ends: Vec<[f64; 2]> = parts.iter().map(|part| x_range(part.outer().points())).collect();
    assert_eq!(ends, [[170.0, 180.0], [-180.0, -170.0]]);
    // A polygon that ends at the end of the map stays whole.
    let whole = polygon(&[square([170, 180], 10)]);
    assert_eq!(split_polygon(whole.clone(), seam).unwrap(), [whole]);
}
