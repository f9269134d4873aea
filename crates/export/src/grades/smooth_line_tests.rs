//! Parts of smooth lines add up, and grades are those of the closed form.

#![allow(clippy::float_cmp, reason = "values that are exact")]

use super::*;

const SMOOTHING: Smoothing = Smoothing { length_m: 100.0 };

/// Up one in ten for 200 m, then level for 100 m.
fn hill() -> SmoothLine {
    let station = |k: u32| {
        let along_m = f64::from(k) * 10.0;
        let height_m = 0.1 * along_m.min(200.0);
        Station { at: [along_m, 0.0], along_m, height_m, ground_m: height_m + 0.5 }
    };
    SmoothLine { stations: (0..=30).map(station).collect() }
}

#[test]
fn grades_of_a_hill() {
    let all = grades_of(&[hill()]);
    assert!((all.ascent_m - 20.0).abs() < 1e-9 && all.descent_m.abs() < 1e-9);
    assert!((all.steepest.unwrap() - 0.1).abs() < 1e-12);
    assert!((hill().grade(20.0) - 0.1).abs() < 1e-12);
    assert!((hill().grade(200.0) - 0.05).abs() < 1e-12);
    assert!(hill().grade(300.0).abs() < 1e-12);
    assert_eq!(grades_of(&[hill().part([0.0, 49.0])]).steepest, None);
    assert_eq!(grades_of(&[hill().part([100.0, 149.0])]).steepest, None);
    assert_eq!(grades_of(&[]), ProfileGrades::default());
    assert!(SmoothLine::default().height_m(3.0).is_nan());
}

#[test]
fn parts_add_up_to_the_whole() {
    for cut_m in [0.0, 3.0, 40.0, 197.3, 300.0] {
        let parts = [[0.0, cut_m], [cut_m, 300.0]].map(|part| hill().part(part));
        let [one, other] = parts.map(|part| grades_of(&[part]).ascent_m);
        assert!((one + other - 20.0).abs() < 1e-9, "{cut_m}: {one} {other}");
    }
    assert!(hill().part([400.0, 500.0]).stations.is_empty());
}

#[test]
fn a_profile_becomes_even_stations_between_its_ends() {
    let line = SmoothLine::of_profile(&[[5.0, 1.0], [9.0, 3.0], [30.0, 2.0]], SMOOTHING);
    let along: Vec<f64> = line.stations.iter().map(|station| station.along_m).collect();
    assert_eq!(along.len(), 4);
    assert!((along[1] - along[0] - 25.0 / 3.0).abs() < 1e-12);
    let ends = [line.stations[0], line.stations[3]].map(|end| (end.height_m, end.ground_m));
    assert_eq!(ends, [(1.0, 1.0), (2.0, 2.0)]);
    assert_eq!(SmoothLine::of_profile(&[], SMOOTHING), SmoothLine::default());
}

/// A peak of 3 m between two stations of a level smooth line counts, and so does a station between
/// two vertices.
#[test]
fn a_smooth_line_is_compared_between_its_stations_too() {
    let level = SmoothLine::itself(&[[0.0, 100.0], [10.0, 100.0], [20.0, 100.0]]);
    let peak = [[0.0, 100.0], [4.0, 100.5], [5.0, 103.0], [6.0, 100.0], [20.0, 100.0]];
    assert_eq!(level.most_off_m(&peak), 3.0);
    let dip = SmoothLine::itself(&[[0.0, 100.0], [10.0, 95.0], [20.0, 100.0]]);
    assert_eq!(dip.most_off_m(&[[0.0, 100.0], [20.0, 100.0]]), 5.0);
    // Only the common part is compared.
    let beyond = dip.most_off_m(&[[15.0, 97.5], [30.0, 112.5]]);
    assert!((beyond - 2.5).abs() < 1e-12, "{beyond}");
    assert_eq!(SmoothLine::default().most_off_m(&peak), 0.0);
}

/// Compares random smooth lines with a dense sample of both lines: the result is never less, and
/// exceeds the sample only by what the sample can miss.
#[test]
fn the_largest_distance_is_that_of_a_dense_sample() {
    let mut state = 7_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as f64 / f64::from(1_u32 << 31)
    };
    for _ in 0..50 {
        let mut profile = |step_m: f64| -> Vec<[f64; 2]> {
            (0..=20).map(|k| [f64::from(k) * step_m, 10.0 * random()]).collect()
        };
        let (smooth, line) = (SmoothLine::itself(&profile(7.0)), profile(7.0 * 20.0 / 20.0));
        let line: Vec<[f64; 2]> =
            line.iter().map(|[along_m, z_m]| [140.0 * (along_m / 140.0).sqrt(), *z_m]).collect();
        let dense = (0..=14_000).map(|k| {
            let along_m = f64::from(k) / 100.0;
            let after = line.partition_point(|[at_m, _]| *at_m < along_m).clamp(1, 20);
            (smooth.height_m(along_m) - between(line[after - 1], line[after], along_m)).abs()
        });
        let (dense, found) = (dense.fold(0.0, f64::max), smooth.most_off_m(&line));
        assert!(found >= dense - 1e-9 && found <= dense + 0.2, "{found} {dense}");
    }
}
