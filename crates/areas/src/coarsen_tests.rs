//! Coarse polygons are valid and close to the fine ones, and shared borders stay shared.

use std::collections::BTreeSet;

use geo::Validation as _;
use proptest::prelude::*;

use super::*;
use crate::OutlineWay;
use crate::{
    Ring,
    chessboard_tests::{cells, polygons_around, to_geo},
};

/// A step of 1 changes nothing.
#[test]
fn the_finest_lattice_leaves_everything() {
    let cells: BTreeSet<(i64, i64)> = [(0, 0), (1, 1), (2, 1), (2, 2), (1, 3)].into();
    for polygon in polygons_around(&cells) {
        assert_eq!(coarsen(&polygon, 1).unwrap(), [polygon]);
    }
}

#[test]
fn what_is_narrower_than_a_step_is_gone() {
    let cells: BTreeSet<(i64, i64)> = [(0, 0)].into();
    assert_eq!(coarsen(&polygons_around(&cells)[0], 1000).unwrap(), []);
}

/// A bow tie is two triangles that touch at the crossing; a square in a square is a hole.
#[test]
fn lines_that_cross_surround_what_the_even_odd_rule_says() {
    let points = |places: &[[i64; 2]]| -> Vec<LatticePoint> {
        places.iter().map(|[u, v]| LatticePoint::new(*u, *v)).collect()
    };
    let tie = points(&[[0, 0], [40, 40], [40, 0], [0, 40]]);
    let found = surrounded(&[&tie], 1).unwrap();
    let areas: Vec<i128> = found.iter().map(Polygon::doubled_area).collect();
    assert_eq!(areas, [800, 800]);
    let outer = points(&[[0, 0], [40, 0], [40, 40], [0, 40]]);
    let inner = points(&[[10, 10], [20, 10], [20, 20], [10, 20]]);
    let found = surrounded(&[&outer, &inner], 1).unwrap();
    assert_eq!((found.len(), found[0].holes().len(), found[0].doubled_area()), (1, 1, 3000));
    assert_eq!(surrounded(&[&points(&[[0, 0], [9, 9]])], 1).unwrap(), []);
}

/// A narrow spike crosses a line that it did not touch before it was coarsened.
#[test]
fn segments_that_come_to_cross_are_led_through_one_point() {
    let outline: Vec<LatticePoint> =
        [[0, 0], [40, 0], [40, 40], [22, 40], [21, 3], [20, 40], [0, 40], [0, 0]]
            .map(|[u, v]| LatticePoint::new(u, v))
            .to_vec();
    let polygon =
        crate::assemble(&[OutlineWay { points: &outline }]).unwrap().polygons.swap_remove(0);
    for step in [3, 4, 6, 8, 10, 13] {
        let coarse = coarsen(&polygon, step).unwrap();
        assert!(coarse.iter().all(|polygon| to_geo(polygon).is_valid()), "{step}");
        let area: i128 = coarse.iter().map(Polygon::doubled_area).sum();
        let off = (area - polygon.doubled_area()).abs();
        assert!(off <= 2 * i128::from(step) * 160, "{step}: {off}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 4 } else { 300 }))]

    /// Coarse polygons are valid, on the coarse lattice, close to the fine ones, and unchanged if
    /// coarsened again.
    #[test]
    fn coarse_polygons_are_valid_and_near(cells in cells(), step in 1_i64..30) {
        for polygon in polygons_around(&cells) {
            let coarse = coarsen(&polygon, step).unwrap();
            for part in &coarse {
                let is_coarse = |point: &LatticePoint| point.u % step == 0 && point.v % step == 0;
                prop_assert!(part.rings().flat_map(Ring::points).all(is_coarse));
                prop_assert!(to_geo(part).is_valid());
                prop_assert_eq!(coarsen(part, step).unwrap(), vec![part.clone()]);
            }
            let points: usize = polygon.rings().map(|ring| ring.points().len()).sum();
            let area: i128 = coarse.iter().map(Polygon::doubled_area).sum();
            // Each side sweeps over less than a step on both sides; sides of cells are at most 14
            // long.
            let off = (area - polygon.doubled_area()).abs();
            prop_assert!(off <= 2 * (14 + i128::from(step)) * i128::from(step) * points as i128, "{off}");
        }
    }

    /// If two areas share a border, their coarse forms share it, too: together they are the coarse
    /// form of both as one.
    #[test]
    fn shared_borders_stay_shared(cells in cells(), step in 1_i64..6, column in 1_i64..8) {
        let (west, east): (BTreeSet<_>, BTreeSet<_>) = cells.iter().copied().partition(|cell| cell.0 < column);
        let coarse_area = |cells: &BTreeSet<(i64, i64)>| -> i128 {
            let polygons = polygons_around_any(cells);
            polygons.iter().flat_map(|polygon| coarsen(polygon, step).unwrap()).map(|p| p.doubled_area()).sum()
        };
        prop_assert_eq!(coarse_area(&west) + coarse_area(&east), coarse_area(&cells));
    }
}

fn polygons_around_any(cells: &BTreeSet<(i64, i64)>) -> Vec<Polygon> {
    if cells.is_empty() { Vec::new() } else { polygons_around(cells) }
}
