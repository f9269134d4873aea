//! Lengths and grades of roads are those of the closed form.

use proptest::prelude::*;

use super::*;

fn line(vertices: &[([f64; 2], f64, bool)], joins: &[usize]) -> JoinedLine {
    let vertices = vertices.iter().map(|&(at, z_m, is_source)| Vertex { at, z_m, is_source });
    JoinedLine { vertices: vertices.collect(), joins: joins.to_vec() }
}

/// One step is one metre.
fn flat_m(from: [f64; 2], to: [f64; 2]) -> f64 {
    (to[0] - from[0]).hypot(to[1] - from[1])
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{found}, not {expected}");
}

/// A straight road of 300 m on a plane that rises 1 in 10 along it, then 100 m down again on a
/// plane that falls 1 in 4: every measure is known.
fn measures(lines: &[JoinedLine]) -> Measures {
    Measures::from_lines(&Profiled::from_lines(lines, &flat_m))
}

#[test]
fn a_road_on_planes_is_measured_in_closed_form() {
    let up: Vec<_> =
        (0..=30).map(|k| ([10.0 * f64::from(k), 0.0], f64::from(k), k % 30 == 0)).collect();
    let down = [([300.0, 60.0], 15.0, false), ([300.0, 100.0], 5.0, true)];
    let all = line(&[&up[..], &down].concat(), &[]);
    let found = measures(&[all]);
    near(found.length_2d_m, 400.0);
    near(found.length_3d_m, 300.0 * 1.01_f64.sqrt() + 100.0 * 1.0625_f64.sqrt());
    near(found.grades.ascent_m, 30.0);
    near(found.grades.descent_m, 25.0);
    near(found.grades.steepest.unwrap(), 0.25);
    assert_eq!((found.vertices_in, found.vertices_out), (3, 33));
}

/// Each line is measured separately: no grade is measured across a gap.
#[test]
fn a_gap_has_no_grade() {
    let first = line(&[([0.0, 0.0], 0.0, true), ([19.0, 0.0], 10.0, true)], &[]);
    let second = line(&[([40.0, 0.0], 100.0, true), ([59.0, 0.0], 100.0, true)], &[]);
    let found = measures(&[first.clone(), second]);
    assert_eq!(found.grades.steepest, None, "no part is 20 m long");
    near(found.length_2d_m, 38.0);
    near(found.grades.ascent_m, 10.0);
    let third = line(&[([100.0, 0.0], 0.0, true), ([120.0, 0.0], 1.0, true)], &[]);
    near(measures(&[first, third]).grades.steepest.unwrap(), 0.05);
}

/// A step of 5 m within 1 m counts over 20 m.
#[test]
fn a_short_step_is_spread_over_the_least_length() {
    let steps = [
        ([0.0, 0.0], 0.0, true),
        ([50.0, 0.0], 0.0, true),
        ([51.0, 0.0], 5.0, true),
        ([100.0, 0.0], 5.0, true),
    ];
    near(measures(&[line(&steps, &[])]).grades.steepest.unwrap(), 0.25);
}

/// A straight line that a border cuts keeps its number of points; a line that bends on the border
/// has one more.
#[test]
fn a_cut_of_a_border_is_no_point_unless_the_line_bends_there() {
    let straight = [
        ([0.0, 0.0], 0.0, true),
        ([500.0, 250.4], 0.0, false),
        ([1000.0, 500.0], 0.0, true),
        ([2000.0, 1001.0], 0.0, true),
    ];
    assert_eq!(source_points(&line(&straight, &[2])), 2);
    let bent =
        [([0.0, 0.0], 0.0, true), ([1000.0, 500.0], 0.0, true), ([2000.0, 900.0], 0.0, true)];
    assert_eq!(source_points(&line(&bent, &[1])), 3);
    let back = [([0.0, 0.0], 0.0, true), ([1000.0, 0.0], 0.0, true), ([500.0, 0.0], 0.0, true)];
    assert_eq!(source_points(&line(&back, &[1])), 3, "the line turns back on the border");
}

/// Returns the steepest grade of a profile by trying very many pairs of places.
fn steepest_by_force(profile: &[[f64; 2]], least_m: f64) -> f64 {
    let [last_m, _] = profile[profile.len() - 1];
    let height = |along_m: f64| {
        let index =
            profile.partition_point(|vertex| vertex[0] <= along_m).clamp(1, profile.len() - 1);
        super::at(profile, index - 1, along_m)[1]
    };
    let places: Vec<f64> = (0..=400).map(|k| last_m * f64::from(k) / 400.0).collect();
    let mut most = 0.0_f64;
    for &from in &places {
        for &to in places.iter().filter(|&&to| to >= from + least_m) {
            most = most.max(((height(to) - height(from)) / (to - from)).abs());
        }
    }
    most
}

proptest! {
    /// No grade over the least length is steeper than the result, and the result occurs.
    #[test]
    fn the_steepest_grade_is_the_steepest(
        steps in prop::collection::vec((0.5_f64..30.0, -5.0_f64..5.0), 2..30),
    ) {
        let mut profile = vec![[0.0, 100.0]];
        for (run_m, rise_m) in steps {
            let [along_m, z_m] = profile[profile.len() - 1];
            profile.push([along_m + run_m, z_m + rise_m]);
        }
        let found = steepest(&profile, LEAST_GRADE_LENGTH_M);
        let [length_m, _] = profile[profile.len() - 1];
        prop_assert_eq!(found.is_some(), length_m >= LEAST_GRADE_LENGTH_M);
        if let Some(found) = found {
            let least = steepest_by_force(&profile, LEAST_GRADE_LENGTH_M);
            prop_assert!(found >= least - 1e-12, "{} is less than {}", found, least);
            // The finest places tried are this far apart; a grade changes little over that
            // distance.
            let share = length_m / 400.0 / LEAST_GRADE_LENGTH_M;
            prop_assert!(found <= least + 22.0 * share, "{} is more than {}", found, least);
        }
    }
}

/// The beginning of a profile does not matter: parts of longer profiles keep their distances.
#[test]
fn a_profile_may_begin_anywhere() {
    let profile = [[0.0, 5.0], [12.0, 6.0], [31.0, 2.0], [40.0, 2.5]];
    let moved = profile.map(|[along_m, height_m]| [along_m + 1000.0, height_m]);
    for least_m in [5.0, 20.0, 39.0, 41.0] {
        let [one, other] = [&profile, &moved].map(|profile| steepest(profile, least_m));
        assert_eq!(one.is_some(), other.is_some(), "{least_m}");
        if let (Some(one), Some(other)) = (one, other) {
            near(one, other);
        }
    }
}
