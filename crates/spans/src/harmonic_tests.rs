//! Heights between fixed joints match closed formulas, are between the fixed heights, and satisfy
//! the defining equation.

use proptest::prelude::*;

use super::*;

const FREE: f64 = f64::NAN;

fn solve(joints: usize, lines: &[([usize; 2], f64)], held_m: &[f64]) -> Vec<f64> {
    let mut harmonic = Harmonic::new(joints);
    for &(ends, length_m) in lines {
        harmonic.tie(ends, length_m);
    }
    harmonic.solve(held_m)
}

#[test]
fn between_two_supports_it_is_straight() {
    let lines = [([0, 1], 10.0), ([1, 2], 30.0), ([2, 3], 60.0)];
    let found = solve(4, &lines, &[100.0, FREE, FREE, 200.0]);
    for (found, expected) in found.iter().zip([100.0, 110.0, 140.0, 200.0]) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
}

/// The centre of a star has the mean of the ends, weighted by one over the lengths of the arms.
#[test]
fn a_star_with_three_arms() {
    let (lengths_m, ends_m): ([f64; 3], [f64; 3]) = ([20.0, 50.0, 80.0], [300.0, 310.0, 290.0]);
    let lines = [([0, 3], lengths_m[0]), ([1, 3], lengths_m[1]), ([2, 3], lengths_m[2])];
    let found = solve(4, &lines, &[ends_m[0], ends_m[1], ends_m[2], FREE])[3];
    let weighted: f64 = ends_m.iter().zip(&lengths_m).map(|(end, length)| end / length).sum();
    let weights: f64 = lengths_m.iter().map(|length| 1.0 / length).sum();
    assert!((found - weighted / weights).abs() < 1e-9, "{found}");
}

#[test]
fn one_support_is_level_to_the_bit_and_none_has_no_height() {
    let lines = [([0, 1], 3.0), ([1, 2], 7.0), ([1, 3], 0.1), ([2, 2], 5.0), ([4, 5], 1.0)];
    let found = solve(6, &lines, &[123.456_789, FREE, FREE, FREE, FREE, FREE]);
    assert_eq!(found[..4], [123.456_789; 4]);
    assert!(found[4].is_nan() && found[5].is_nan());
}

/// A network that no real span forms, but that a hostile file can contain, is rejected and does not
/// take forever.
#[test]
fn what_is_tied_to_all_else_is_not_solved() {
    let count = 600;
    let lines: Vec<([usize; 2], f64)> =
        (0..count).flat_map(|one| (0..one).map(move |other| ([one, other], 1.0))).collect();
    let mut held_m = vec![FREE; count];
    held_m[0] = 5.0;
    assert!(solve(count, &lines, &held_m)[1..].iter().all(|height_m| height_m.is_nan()));
}

proptest! {
    #[test]
    fn free_joints_are_the_mean_of_their_neighbours_and_between_the_highest_and_the_lowest(
        lines in prop::collection::vec(((0..14_usize, 0..14_usize), 0.1_f64..500.0), 5..40),
        held in prop::collection::btree_map(0..14_usize, 0.0_f64..3000.0, 1..5),
    ) {
        let held_m: Vec<f64> = (0..14).map(|joint| held.get(&joint).copied().unwrap_or(FREE)).collect();
        let lines: Vec<([usize; 2], f64)> =
            lines.into_iter().map(|((one, other), length_m)| ([one, other], length_m)).collect();
        let found = solve(14, &lines, &held_m);
        let [least, most] = [f64::min, f64::max].map(|of| held.values().copied().reduce(of).unwrap());
        for (joint, &height_m) in found.iter().enumerate() {
            if let Some(&own_m) = held.get(&joint) {
                prop_assert_eq!(height_m.to_bits(), own_m.to_bits());
                continue;
            }
            if height_m.is_nan() {
                continue;
            }
            prop_assert!(height_m >= least - 1e-6 && height_m <= most + 1e-6);
            let of_joint = lines.iter().filter(|(ends, _)| ends.contains(&joint) && ends[0] != ends[1]);
            let pull: f64 = of_joint
                .map(|(ends, length_m)| (found[ends[0] + ends[1] - joint] - height_m) / length_m)
                .sum();
            prop_assert!(pull.abs() < 1e-6, "{joint}: {pull}");
        }
    }
}
