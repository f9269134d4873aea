//! The smooth line against closed forms, and against a dense solution of the same equations.

use std::f64::consts::TAU;

use proptest::prelude::*;

use super::*;

const SMOOTHING: Smoothing = Smoothing { length_m: 200.0 };

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found}, not {expected}");
}

#[test]
fn what_is_smoothed_follows_the_cell() {
    for (cell_m, length_m) in [(1.0, 100.0), (30.0, 135.0), (92.6, 400.0)] {
        near(Smoothing::of_cell(cell_m).length_m, length_m, 1e-9);
    }
}

#[test]
fn straight_lines_stay() {
    let line: Vec<f64> = (0..40).map(|k| 500.0 + 0.7 * f64::from(k)).collect();
    for held in [[None, None], [Some(line[0]), Some(line[39])], [None, Some(line[39])]] {
        for (found, expected) in SMOOTHING.solve(7.5, &line, held).iter().zip(&line) {
            near(*found, *expected, 1e-8);
        }
    }
}

/// A wave of the smoothing's length keeps half of its amplitude, one three times as long 81/82, one
/// half as long 1/17.
#[test]
fn of_a_wave_of_its_length_half_is_left() {
    for (factor, left) in [(1.0, 0.5), (3.0, 81.0 / 82.0), (0.5, 1.0 / 17.0)] {
        let spacing_m = 1.0;
        let wave = |k: usize| (TAU * k as f64 * spacing_m / (200.0 * factor)).sin();
        let heights: Vec<f64> = (0..6001).map(wave).collect();
        let smooth = SMOOTHING.solve(spacing_m, &heights, [None, None]);
        let middle = 2000..4000;
        let most = |values: &[f64]| values[middle.clone()].iter().copied().fold(0.0, f64::max);
        near(most(&smooth), left * most(&heights), 1e-3);
    }
}

#[test]
fn ends_that_are_held_stay_and_short_lines_are_lines() {
    let smooth = SMOOTHING.solve(10.0, &[1.0, 9.0, 2.0, 8.0], [Some(3.0), Some(4.0)]);
    near(smooth[0], 3.0, 0.0);
    near(smooth[3], 4.0, 0.0);
    for (held, expected) in [([None, None], [5.0, 6.0]), ([Some(1.0), Some(2.0)], [1.0, 2.0])] {
        let line = SMOOTHING.solve(10.0, &[5.0, 6.0], held);
        near(line[0], expected[0], 0.0);
        near(line[1], expected[1], 0.0);
    }
}

/// An estimate is the height of the free line; a line fixed at another height costs as much more as
/// the weight states.
#[test]
fn an_estimate_says_what_another_height_costs() {
    let heights: Vec<f64> = (0..30).map(|k| f64::from(k * 7919 % 13)).collect();
    let cost = |z: &[f64]| -> f64 {
        let spacing_m = 10.0_f64;
        let off: f64 = z.iter().zip(&heights).map(|(z, g)| spacing_m * (z - g).powi(2)).sum();
        let bend = z.windows(3).map(|z| ((z[0] - 2.0 * z[1] + z[2]) / spacing_m.powi(2)).powi(2));
        off + (200.0 / TAU).powi(4) * spacing_m * bend.sum::<f64>()
    };
    let free = SMOOTHING.solve(10.0, &heights, [None, None]);
    let WeightedHeight { height_m, weight } = SMOOTHING.estimate(10.0, &heights, 0);
    near(height_m, free[0], 1e-9);
    let held = SMOOTHING.solve(10.0, &heights, [Some(height_m + 2.0), None]);
    near(cost(&held) - cost(&free), weight * 4.0, 1e-6 * cost(&held));
    // The height in the middle of a line is better determined than at its end.
    assert!(SMOOTHING.estimate(10.0, &heights, 15).weight > 2.0 * weight);
}

/// The beginning of a ring does not matter.
#[test]
fn a_ring_has_no_beginning() {
    for count in [3, 17, 200] {
        let heights: Vec<f64> = (0..count).map(|k| f64::from(k * 7919 % 13)).collect();
        let mut turned = heights.clone();
        turned.rotate_left(2);
        let mut smooth = SMOOTHING.solve_ring(10.0, &heights);
        smooth.rotate_left(2);
        for (found, expected) in SMOOTHING.solve_ring(10.0, &turned).iter().zip(&smooth) {
            near(*found, *expected, 0.01);
        }
    }
}

proptest! {
    /// The solution has the least cost: any other line costs more.
    #[test]
    fn no_other_line_costs_less(
        heights in prop::collection::vec(-50.0..50.0_f64, 3..40),
        change in prop::collection::vec(-1.0..1.0_f64, 40),
    ) {
        let cost = |z: &[f64]| -> f64 {
            let off: f64 = z.iter().zip(&heights).map(|(z, g)| 10.0 * (z - g).powi(2)).sum();
            let bend = z.windows(3).map(|z| ((z[0] - 2.0 * z[1] + z[2]) / 100.0).powi(2));
            off + (200.0 / TAU).powi(4) * 10.0 * bend.sum::<f64>()
        };
        let best = SMOOTHING.solve(10.0, &heights, [None, None]);
        let other: Vec<f64> = best.iter().zip(&change).map(|(z, change)| z + change).collect();
        prop_assert!(cost(&best) <= cost(&other) + 1e-6);
        // The reversed line has the reversed solution.
        let turned: Vec<f64> = heights.iter().rev().copied().collect();
        let mut back = SMOOTHING.solve(10.0, &turned, [None, None]);
        back.reverse();
        for (one, other) in best.iter().zip(&back) {
            prop_assert!((one - other).abs() < 1e-7);
        }
    }
}
