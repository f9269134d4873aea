//! Two fingers zoom, rotate or tilt.

use super::*;

fn at(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

#[test]
fn fingers_that_part_zoom_and_those_that_turn_turn() {
    let mut fingers = Fingers::begin(DVec3::ZERO, [at(100.0, 100.0), at(200.0, 100.0)]);
    assert_eq!(fingers.move_to([at(99.0, 100.0), at(201.0, 100.0)], 1.0), FingerStep::None);
    let step = fingers.move_to([at(50.0, 100.0), at(250.0, 100.0)], 1.0);
    let FingerStep::Pinch { levels, clockwise_deg, between_px } = step else { panic!("{step:?}") };
    assert!((levels - 1.0).abs() < 1e-12 && clockwise_deg.abs() < 1e-12, "{step:?}");
    assert_eq!(between_px, at(150.0, 100.0));
    // The right finger goes down, the left one up: clockwise.
    let step = fingers.move_to([at(150.0, 0.0), at(150.0, 200.0)], 1.0);
    let FingerStep::Pinch { levels, clockwise_deg, .. } = step else { panic!("{step:?}") };
    assert!(levels.abs() < 1e-12 && (clockwise_deg - 90.0).abs() < 1e-9, "{step:?}");
}

#[test]
fn fingers_that_go_down_together_tilt() {
    let mut fingers = Fingers::begin(DVec3::ZERO, [at(100.0, 100.0), at(200.0, 110.0)]);
    // The positions of the two fingers arrive one after the other.
    assert_eq!(fingers.move_to([at(100.0, 109.0), at(200.0, 110.0)], 1.0), FingerStep::None);
    let step = fingers.move_to([at(101.0, 110.0), at(200.0, 119.0)], 1.0);
    assert_eq!(step, FingerStep::Tilt { points: 9.5 });
    // The gesture stays a tilt, even if the fingers come nearer to each other.
    let step = fingers.move_to([at(111.0, 114.0), at(190.0, 123.0)], 2.0);
    assert_eq!(step, FingerStep::Tilt { points: 2.0 });
}
