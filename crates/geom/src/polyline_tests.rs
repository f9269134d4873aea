//! A polyline has at least two points, and no two neighbours are equal.

use super::*;

#[test]
fn merges_equal_neighbours_and_refuses_a_single_point() {
    let p = |u, v| LatticePoint::new(u, v);
    let line = Polyline::new(vec![p(0, 0), p(0, 0), p(3, 4), p(3, 4), p(0, 0)]).unwrap();
    assert_eq!(line.points(), [p(0, 0), p(3, 4), p(0, 0)]);
    assert_eq!(Polyline::new(vec![p(1, 1), p(1, 1)]), Err(PolylineError { distinct: 1 }));
}
