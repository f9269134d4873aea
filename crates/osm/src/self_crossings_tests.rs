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
    // A loop through one of its own points, and a T into the middle of a segment.
    check_crossings(&[(0, 0), (10, 0), (15, 5), (20, 0), (10, 0), (10, -9)], 0);
    check_crossings(&[(0, 0), (10, 0), (10, 5), (5, 5), (5, 0)], 0);
    // A five-pointed star.
    check_crossings(&[(0, 100), (59, -81), (-95, 31), (95, 31), (-59, -81), (0, 100)], 5);
    check_crossings(&[(5, -5), (5, 5), (0, 0), (10, 0)], 1);
}
