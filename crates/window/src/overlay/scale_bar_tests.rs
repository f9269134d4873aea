//! Scale bars are the longest round length that fits.

use super::*;

#[test]
fn scale_bars_are_the_longest_of_one_two_five_that_fit() {
    let check = |metres_per_point, most, length_m: f64, points: f32| {
        let bar = ScaleBar::new(metres_per_point, most).unwrap();
        assert!((bar.length_m / length_m - 1.0).abs() < 1e-9, "{bar:?}");
        assert!((bar.points - points).abs() < 1e-3 && bar.points <= most, "{bar:?}");
    };
    check(1.0, 160.0, 100.0, 100.0);
    check(1.0, 200.0, 200.0, 200.0);
    check(3.0, 160.0, 200.0, 66.666_67);
    check(3.2, 160.0, 500.0, 156.25);
    check(0.001, 160.0, 0.1, 100.0);
    check(70.0, 160.0, 10_000.0, 142.857_15);
}

#[test]
fn without_a_scale_there_is_no_bar() {
    for metres_per_point in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(ScaleBar::new(metres_per_point, 160.0), None);
    }
    assert_eq!(ScaleBar::new(1.0, -20.0), None);
}
