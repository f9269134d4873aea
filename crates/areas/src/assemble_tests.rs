//! Outlines of any order and direction become polygons with holes; open and crossing outlines are
//! rejected.

use geo::Validation as _;
use proptest::prelude::*;

use super::*;
use crate::OutlineWay;
use crate::chessboard_tests::{DOUBLED_CELL, cells, groups, to_geo, ways_around};

fn points(list: &[[i64; 2]]) -> Vec<LatticePoint> {
    list.iter().map(|&[u, v]| LatticePoint::new(u, v)).collect()
}

fn try_assembling(ways: &[Vec<LatticePoint>]) -> Result<AssembledArea, OutlineError> {
    let ways: Vec<OutlineWay<'_>> = ways.iter().map(|points| OutlineWay { points }).collect();
    assemble(&ways)
}

fn assembled_from(ways: &[&[[i64; 2]]]) -> Result<AssembledArea, OutlineError> {
    try_assembling(&ways.iter().map(|way| points(way)).collect::<Vec<_>>())
}

fn square(west: i64, south: i64, side: i64) -> [[i64; 2]; 5] {
    let (east, north) = (west + side, south + side);
    [[west, south], [east, south], [east, north], [west, north], [west, south]]
}

/// Returns the doubled area and the number of holes of each polygon.
fn figures(assembled: &AssembledArea) -> Vec<(i128, usize)> {
    assembled
        .polygons
        .iter()
        .map(|polygon| (polygon.doubled_area(), polygon.holes().len()))
        .collect()
}

#[test]
fn a_closed_way_is_a_polygon_counter_clockwise() {
    let mut outline = square(2, 3, 10);
    outline.reverse();
    let assembled = assembled_from(&[&outline]).unwrap();
    assert_eq!(assembled.polygons[0].outer().points(), points(&square(2, 3, 10)[..4]));
    assert_eq!(figures(&assembled), [(200, 0)]);
}

#[test]
fn holes_and_islands_nest_to_any_depth() {
    let rings = [square(0, 0, 100), square(10, 10, 80), square(20, 20, 60), square(30, 30, 40)];
    let assembled = assembled_from(&rings.each_ref().map(|ring| &ring[..])).unwrap();
    let doubled = |outer: i128, hole: i128| 2 * (outer * outer - hole * hole);
    assert_eq!(figures(&assembled), [(doubled(100, 80), 1), (doubled(60, 40), 1)]);
}

#[test]
fn rings_that_touch_at_a_point_are_told_apart() {
    // Two squares that touch at a corner are two polygons; a hole that touches its outer ring stays
    // a hole.
    assert_eq!(
        figures(&assembled_from(&[&square(0, 0, 2), &square(2, 2, 2)]).unwrap()),
        [(8, 0), (8, 0)]
    );
    let hole = [[0, 0], [3, 1], [1, 3], [0, 0]];
    let assembled = assembled_from(&[&square(0, 0, 10), &hole]).unwrap();
    assert_eq!(figures(&assembled), [(200 - 8, 1)]);
    // Two holes that touch each other are also kept.
    let assembled =
        assembled_from(&[&square(0, 0, 10), &square(2, 2, 2), &square(4, 4, 2)]).unwrap();
    assert_eq!(figures(&assembled), [(200 - 16, 2)]);
}

#[test]
fn one_way_that_touches_itself_is_divided() {
    // The ring passes through (0, 0) twice, around two triangles.
    let eight = [[0, 0], [4, 1], [4, -1], [0, 0], [-4, 1], [-4, -1], [0, 0]];
    assert_eq!(figures(&assembled_from(&[&eight]).unwrap()), [(8, 0), (8, 0)]);
}

#[test]
fn a_shared_border_counts_as_none() {
    let assembled = assembled_from(&[&square(0, 0, 2), &square(2, 0, 2)]).unwrap();
    assert_eq!(figures(&assembled), [(16, 0)]);
    assert_eq!(assembled.repeated_segments, 1);
}

#[test]
fn a_point_in_the_middle_of_a_segment_divides_it() {
    // The right square touches the longer side of the left one.
    let assembled = assembled_from(&[&square(0, 0, 6), &square(6, 2, 2)]).unwrap();
    assert_eq!(figures(&assembled), [(72 + 8, 0)]);
    assert_eq!((assembled.divided_segments, assembled.repeated_segments), (2, 1));
}

#[test]
fn open_and_crossing_outlines_are_refused() {
    let open = assembled_from(&[&square(0, 0, 4)[..4]]).unwrap_err();
    assert_eq!(open, OutlineError::Open { ends: 2, first: LatticePoint::new(0, 0) });
    let crossing = assembled_from(&[&[[0, 0], [4, 4], [4, 0], [0, 4], [0, 0]]]).unwrap_err();
    assert!(matches!(crossing, OutlineError::Crossing { .. }), "{crossing}");
    let overlapping = assembled_from(&[&square(0, 0, 4), &square(2, 2, 4)]).unwrap_err();
    assert!(matches!(overlapping, OutlineError::Crossing { .. }), "{overlapping}");
}

#[test]
fn nothing_is_left_of_points_and_of_lines_there_and_back() {
    for way in [&[[1, 1]][..], &[[1, 1], [1, 1]], &[[0, 0], [5, 5], [0, 0]], &[]] {
        assert_eq!(assembled_from(&[way]).unwrap_err(), OutlineError::Nothing);
    }
}

#[test]
fn far_coordinates_do_not_overflow() {
    let [west, east] = [-1_800_000_000, 1_800_000_000];
    let ring =
        [[west, -900_000_000], [east, -900_000_001], [east, 900_000_000], [west, -900_000_000]];
    let hole = square(1_000_000_000, 1, 1_000);
    let assembled = assembled_from(&[&ring, &hole]).unwrap();
    let doubled = 3_600_000_000_i128 * 1_800_000_001 - 2_000_000;
    assert_eq!(figures(&assembled), [(doubled, 1)]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 4 } else { 400 }))]

    /// Whatever ways enclose some cells, the polygons are these cells: one polygon for each group
    /// that is connected by sides, with the group's area, and valid by the rules of Simple
    /// Features.
    #[test]
    fn polygons_are_the_cells_that_were_surrounded(cells in cells(), seed in 1_u64..) {
        let assembled = try_assembling(&ways_around(&cells, seed)).unwrap();
        let area: i128 = assembled.polygons.iter().map(Polygon::doubled_area).sum();
        prop_assert_eq!(area, DOUBLED_CELL * cells.len() as i128);
        prop_assert_eq!(assembled.polygons.len(), groups(&cells));
        for polygon in &assembled.polygons {
            let of_geo = to_geo(polygon);
            prop_assert!(of_geo.is_valid(), "{:?}", of_geo.validation_errors());
            prop_assert!(polygon.outer().doubled_area() > 0);
            prop_assert!(polygon.holes().iter().all(|hole| hole.doubled_area() < 0));
        }
    }

    /// The order and the direction of ways do not matter, nor does it matter where they are cut.
    #[test]
    fn polygons_do_not_depend_on_the_ways(cells in cells(), seeds in [1_u64.., 1_u64..]) {
        let [one, other] = seeds.map(|seed| try_assembling(&ways_around(&cells, seed)).unwrap());
        prop_assert_eq!(one, other);
    }

    /// An outline with one missing segment is open at two ends.
    #[test]
    fn a_missing_segment_leaves_two_open_ends(cells in cells(), seed in 1_u64..) {
        let mut ways = ways_around(&cells, seed);
        ways[0].pop();
        if ways[0].is_empty() {
            ways.remove(0);
        }
        let error = try_assembling(&ways).unwrap_err();
        let is_open = matches!(error, OutlineError::Open { ends: 2, .. });
        prop_assert!(is_open || error == OutlineError::Nothing, "{}", error);
    }
}
