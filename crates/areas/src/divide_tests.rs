//! The two parts of a divided polygon add up to the whole.

use std::collections::BTreeSet;

use geo::Validation as _;
use proptest::prelude::*;

use super::*;
use crate::OutlineWay;
use crate::chessboard_tests::{cells, polygons_around, to_geo};

fn doubled_area(polygons: &[Polygon]) -> i128 {
    polygons.iter().map(Polygon::doubled_area).sum()
}

/// Returns the stretches of the line along which the borders of some polygons run: stretches that
/// do not touch, in order.
fn along_line(polygons: &[Polygon], line: DivisionLine) -> Vec<[i64; 2]> {
    let segments = polygons.iter().flat_map(Polygon::rings).flat_map(Ring::segments);
    let on_line = segments.filter(|ends| ends.iter().all(|&end| line.along(end) == line.at));
    let mut pieces: Vec<[i64; 2]> = on_line
        .map(|ends| {
            let [a, b] = ends.map(|end| line.across(end));
            [a.min(b), a.max(b)]
        })
        .collect();
    pieces.sort_unstable();
    pieces.dedup_by(|later, piece| {
        let touches = later[0] <= piece[1];
        piece[1] = piece[1].max(if touches { later[1] } else { piece[1] });
        touches
    });
    pieces
}

#[test]
fn a_comb_falls_into_its_teeth() {
    // Three teeth point to the east and are joined in the west.
    let outline: Vec<LatticePoint> = [
        [0, 0],
        [10, 0],
        [10, 2],
        [4, 2],
        [4, 4],
        [10, 4],
        [10, 6],
        [4, 6],
        [4, 8],
        [10, 8],
        [10, 10],
        [0, 10],
        [0, 0],
    ]
    .map(|[u, v]| LatticePoint::new(u, v))
    .to_vec();
    let comb = crate::assemble(&[OutlineWay { points: &outline }]).unwrap().polygons.swap_remove(0);
    let [back, teeth] = divide(&comb, Axis::East, 6).unwrap();
    assert_eq!((back.len(), teeth.len()), (1, 3));
    assert!(teeth.iter().all(|tooth| tooth.doubled_area() == 16));
    // The line is exactly where the teeth begin: only the teeth's own points on the line belong to
    // both parts.
    let [back, teeth] = divide(&comb, Axis::East, 4).unwrap();
    assert_eq!((doubled_area(&back), teeth.len()), (80, 3));
    // The line is outside the polygon.
    assert_eq!(divide(&comb, Axis::North, 10).unwrap(), [vec![comb.clone()], vec![]]);
    assert_eq!(divide(&comb, Axis::North, -3).unwrap(), [vec![], vec![comb]]);
}

/// Returns the corner of a cell whose sides are horizontal and vertical.
fn upright([x, y]: [i64; 2]) -> LatticePoint {
    LatticePoint::new(10 * x, 10 * y)
}

/// Returns the polygons around cells whose sides are horizontal and vertical.
fn upright_polygons(cells: &BTreeSet<(i64, i64)>) -> Vec<Polygon> {
    let ring = |&(x, y): &(i64, i64)| {
        [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1], [x, y]].map(upright)
    };
    let rings: Vec<_> = cells.iter().map(ring).collect();
    let ways: Vec<_> = rings.iter().map(|points| OutlineWay { points }).collect();
    crate::assemble(&ways).unwrap().polygons
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 4 } else { 300 }))]

    /// Nothing is lost and nothing occurs twice, except for rounding on the line, where both parts
    /// have the same border. Both parts are valid.
    #[test]
    fn parts_add_up(cells in cells(), is_east: bool, at in -25_i64..130) {
        let axis = if is_east { Axis::East } else { Axis::North };
        let line = DivisionLine { axis, at };
        for polygon in polygons_around(&cells) {
            let [smaller, larger] = divide(&polygon, axis, at).unwrap();
            prop_assert!(smaller.iter().flat_map(Polygon::rings).flat_map(Ring::points).all(|&p| line.along(p) <= at));
            prop_assert!(larger.iter().flat_map(Polygon::rings).flat_map(Ring::points).all(|&p| line.along(p) >= at));
            if !smaller.is_empty() && !larger.is_empty() {
                prop_assert_eq!(along_line(&smaller, line), along_line(&larger, line));
            }
            // A cut moves by at most half a step, and the area that it moves is a triangle no
            // longer than a side of a cell.
            let cuts = 2 + 2 * along_line(&smaller, line).len() as i128;
            let off = doubled_area(&smaller) + doubled_area(&larger) - polygon.doubled_area();
            prop_assert!(off.abs() <= 12 * cuts, "{off}");
            for part in smaller.iter().chain(&larger) {
                prop_assert!(to_geo(part).is_valid());
            }
        }
    }

    /// If the outline runs along the line, nothing moves: each part is what is on its side of the
    /// line. So only one part covers the line there.
    #[test]
    fn a_line_along_the_outline(cells in cells(), is_east: bool, column in 0_i64..10) {
        let axis = if is_east { Axis::East } else { Axis::North };
        let line = DivisionLine { axis, at: 10 * column };
        let is_smaller = |&(x, y): &(i64, i64)| (if is_east { x } else { y }) < column;
        let sides: [BTreeSet<_>; 2] = [true, false].map(|side| cells.iter().copied().filter(|cell| is_smaller(cell) == side).collect());
        let [mut smaller, mut larger] = [Vec::new(), Vec::new()];
        for polygon in upright_polygons(&cells) {
            let [one, other] = divide(&polygon, axis, line.at).unwrap();
            smaller.extend(one);
            larger.extend(other);
        }
        for (parts, side, offset) in [(smaller, &sides[0], -1), (larger, &sides[1], 0)] {
            prop_assert_eq!(doubled_area(&parts), 200 * side.len() as i128);
            let beside = |place: i64| if is_east { (column + offset, place) } else { (place, column + offset) };
            let covered: Vec<i64> = (0..9).filter(|&place| side.contains(&beside(place))).collect();
            let expected: Vec<[i64; 2]> = covered.chunk_by(|a, b| a + 1 == *b).map(|run| [10 * run[0], 10 * run[run.len() - 1] + 10]).collect();
            prop_assert_eq!(along_line(&parts, line), expected);
        }
    }
}
