//! The bounds of several extracts contain all their boxes, also across the antimeridian.

use super::*;

fn check(boxes: &[[f64; 4]], wanted: [f64; 4]) {
    let found = with_margin(around(boxes));
    let near = found.iter().zip(&wanted).all(|(found, wanted)| (found - wanted).abs() < 1.5e-4);
    assert!(near, "{found:?}, not {wanted:?}");
}

#[test]
fn bounds_are_around_all_boxes_with_a_margin() {
    check(&[[9.0, 47.0, 10.0, 48.0]], [8.99, 46.99, 10.01, 48.01]);
    // The margin is at least 0.002 degrees.
    check(&[[9.0, 47.0, 9.01, 47.02]], [8.998, 46.998, 9.012, 47.022]);
    check(&[[9.0, 47.0, 10.0, 48.0], [11.0, 46.0, 12.0, 47.0]], [8.97, 45.98, 12.03, 48.02]);
}

#[test]
fn bounds_may_cross_the_end_of_the_earth() {
    check(&[[179.0, -20.0, -179.0, -19.0]], [178.98, -20.01, -178.98, -18.99]);
    check(
        &[[178.0, -20.0, 179.0, -19.0], [-179.0, -20.0, -178.0, -19.0]],
        [177.96, -20.01, -177.96, -18.99],
    );
    check(
        &[[-179.0, -20.0, -178.0, -19.0], [178.0, -20.0, 179.0, -19.0]],
        [177.96, -20.01, -177.96, -18.99],
    );
    check(&[[170.0, 0.0, 180.0, 1.0]], [169.9, -0.01, -179.9, 1.01]);
    check(&[[-180.0, -90.0, 180.0, 90.0]], [-180.0, -90.0, 180.0, 90.0]);
}
