//! Parts of smooth lines add up, and grades are those of the closed form.

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
    let all = SmoothGrades::of(&[hill()]);
    assert!((all.ascent_m - 20.0).abs() < 1e-9 && all.descent_m.abs() < 1e-9);
    assert!((all.steepest.unwrap() - 0.1).abs() < 1e-12);
    assert!((all.most_off_m - 0.5).abs() < 1e-12);
    assert!((hill().grade(20.0) - 0.1).abs() < 1e-12);
    assert!((hill().grade(200.0) - 0.05).abs() < 1e-12);
    assert!(hill().grade(300.0).abs() < 1e-12);
    assert_eq!(SmoothGrades::of(&[hill().part([0.0, 49.0])]).steepest, None);
    assert_eq!(SmoothGrades::of(&[hill().part([100.0, 149.0])]).steepest, None);
    assert_eq!(SmoothGrades::of(&[]), SmoothGrades::default());
    assert!(SmoothLine::default().height_m(3.0).is_nan());
}

#[test]
fn parts_add_up_to_the_whole() {
    for cut_m in [0.0, 3.0, 40.0, 197.3, 300.0] {
        let parts = [[0.0, cut_m], [cut_m, 300.0]].map(|part| hill().part(part));
        let [one, other] = parts.map(|part| SmoothGrades::of(&[part]).ascent_m);
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
