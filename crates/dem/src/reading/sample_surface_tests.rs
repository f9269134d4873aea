//! Parabolas through three known points.

use super::*;

/// Parabolas that are largest between the points, at an end, and where they change sign.
#[test]
fn the_largest_value_of_a_parabola_is_found() {
    let along = |a: f64, b: f64, c: f64| {
        let at = |t: f64| a + t * (b + t * c);
        let found = largest_of_parabola(at(0.0), at(0.5), at(1.0));
        let expected = (0..=10_000).map(|k| at(f64::from(k) / 1e4).abs()).fold(0.0, f64::max);
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    };
    for [a, b, c] in
        [[1.0, 4.0, -5.0], [0.0, 0.0, 0.0], [2.0, -9.0, 9.0], [0.0, 1.0, 0.0], [1.0, -3.0, 1.4]]
    {
        along(a, b, c);
    }
}
