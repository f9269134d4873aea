//! Ripples are removed, and form is preserved.

use proptest::prelude::*;

use super::*;

fn grid(side: usize, height_m: impl Fn(f64, f64) -> f64) -> HeightGrid {
    HeightGrid::from_fn(side, side, |column, row| height_m(column as f64, row as f64) as f32)
}

/// Mean square of the error of slopes to the east, between neighbouring nodes.
fn slope_error(grid: &HeightGrid, truth: impl Fn(f64) -> f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for row in 0..grid.rows() {
        for column in 1..grid.columns() {
            let at = |column| f64::from(grid.height(column, row).unwrap_or(f32::NAN));
            let found = at(column) - at(column - 1);
            // The grid lacks the outermost nodes of the true heights.
            let wanted = truth(column as f64 + 1.0) - truth(column as f64);
            sum += (found - wanted).powi(2);
            count += 1.0;
        }
    }
    sum / count
}

#[test]
fn gentle_ground_in_whole_metres_has_less_than_half_of_its_ripples() {
    let plane = |east: f64| 400.0 + 0.31 * east;
    let stored = grid(66, |east, _| plane(east).round());
    let before = slope_error(&low_passed(&stored, 0.0), plane);
    let after = slope_error(&low_passed(&stored, 1.0), plane);
    assert!(after < 0.25 * before, "{after}, before {before}");
}

#[test]
fn steep_form_stays_to_the_bit() {
    let ridge = grid(66, |east, south| 900.0 - 12.0 * (east - 30.0).abs() + south.round());
    let (kept, shown) = (low_passed(&ridge, 0.0), low_passed(&ridge, 1.0));
    assert_eq!(kept.raw(), ridge.inner(1).raw());
    assert_eq!(shown.raw(), kept.raw());
}

#[test]
fn gaps_stay_gaps_and_move_nothing_beside_them() {
    let level = grid(20, |east, south| if east < 9.0 && south > 4.0 { f64::NAN } else { 7.0 });
    let shown = low_passed(&level, 1.0);
    for (found, wanted) in shown.raw().iter().zip(level.inner(1).raw()) {
        assert_eq!(found.to_bits(), wanted.to_bits());
    }
}

proptest! {
    #[test]
    fn nothing_moves_far_and_two_tiles_agree(
        heights in proptest::collection::vec(-3_i8..4, 12 * 9),
        step_m in prop_oneof![Just(0.25), Just(1.0), Just(3.0)],
    ) {
        let at = |column: usize, row: usize| f32::from(heights[row * 12 + column]);
        let whole = HeightGrid::from_fn(12, 9, at);
        let shown = low_passed(&whole, step_m);
        for row in 0..7 {
            for column in 0..10 {
                let moved = shown.height(column, row).unwrap() - at(column + 1, row + 1);
                prop_assert!(f64::from(moved.abs()) <= 0.4 * step_m + 1e-6);
            }
        }
        // Columns 5 to 7 of both: the last column of one tile and its halo, the first of the next.
        let east = low_passed(&whole.window(4, 0, 8, 9), step_m);
        for row in 0..7 {
            for column in 0..6 {
                prop_assert_eq!(east.height(column, row), shown.height(column + 4, row));
            }
        }
    }
}
