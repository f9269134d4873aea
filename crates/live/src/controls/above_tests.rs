//! The view from above keeps its scale, and the ground stays under the cursor.

use corniche_viewer::camera::CameraProjection;

use super::*;

/// The pixel at which the ground at a place appears.
fn seen_at(navigator: &Navigator, [x, y]: [f64; 2]) -> DVec2 {
    let point = DVec3::new(x, y, HILLY.at(x, y));
    navigator.camera().project(point).unwrap().0
}

#[test]
fn from_above_the_grabbed_ground_stays_under_the_cursor() {
    let mut navigator = looking(30.0, 50.0, 2000.0);
    let middle =
        navigator.view().ground_at(DVec2::new(400.0, 300.0), SIZE_PX, 4e4, &HILLY).unwrap();
    navigator.handle(&Input::ToggleAbove, 0.0, &HILLY);
    assert!(navigator.camera().projection != CameraProjection::Perspective);
    let at = seen_at(&navigator, [middle.x, middle.y]);
    assert!(at.distance(DVec2::new(400.0, 300.0)) < 1e-6, "{at}");
    let before_px = navigator.camera().pixel_at_depth_m(0.0);
    let grabbed = navigator.view().ground_at(DVec2::new(250.0, 420.0), SIZE_PX, 4e4, &HILLY);
    let grabbed = grabbed.unwrap();
    navigator.handle(&press(Button::Left, 250.0, 420.0), 0.0, &HILLY);
    for step in 1..=20 {
        let (x, y) = (250.0 + 7.0 * f64::from(step), 420.0 - 9.0 * f64::from(step));
        navigator.handle(&to(x, y), 0.1, &HILLY);
        let at = seen_at(&navigator, [grabbed.x, grabbed.y]);
        assert!(at.distance(DVec2::new(x, y)) < 1e-6, "{at}");
    }
    navigator.handle(&Input::Release { button: Button::Left }, 5.0, &HILLY);
    let after_px = navigator.camera().pixel_at_depth_m(0.0);
    assert!((after_px / before_px - 1.0).abs() < 1e-9, "a drag does not zoom");

    // The wheel zooms at the cursor, by whole levels for three notches.
    let at_px = DVec2::new(600.0, 150.0);
    let under = navigator.view().ground_at(at_px, SIZE_PX, 4e4, &HILLY).unwrap();
    navigator.has_inertia = false;
    navigator.handle(&Input::Wheel { steps: 3.0, at_px }, 6.0, &HILLY);
    navigator.advance(6.1, &HILLY);
    assert!(seen_at(&navigator, [under.x, under.y]).distance(at_px) < 1e-6);
    let zoomed_px = navigator.camera().pixel_at_depth_m(0.0);
    assert!((zoomed_px / after_px - 0.5).abs() < 1e-9, "{zoomed_px} {after_px}");

    // Rotating keeps the middle and never tilts.
    let heading_deg = navigator.view().orientation.heading_deg;
    let middle =
        navigator.view().ground_at(DVec2::new(400.0, 300.0), SIZE_PX, 4e4, &HILLY).unwrap();
    navigator.handle(&press(Button::Right, 400.0, 300.0), 7.0, &HILLY);
    navigator.handle(&to(430.0, 200.0), 7.1, &HILLY);
    navigator.handle(&Input::Release { button: Button::Right }, 9.0, &HILLY);
    assert!(seen_at(&navigator, [middle.x, middle.y]).distance(DVec2::new(400.0, 300.0)) < 1e-6);
    let orientation = navigator.view().orientation;
    assert!((orientation.heading_deg - heading_deg).abs() > 5.0 && orientation.pitch_deg == 0.0);

    // Back in perspective the same place is in the middle, about as large.
    navigator.handle(&Input::ToggleAbove, 10.0, &HILLY);
    assert_eq!(navigator.camera().projection, CameraProjection::Perspective);
    assert!(seen_at(&navigator, [middle.x, middle.y]).distance(DVec2::new(400.0, 300.0)) < 1.0);
    let (_, depth_m) = navigator.camera().project(middle).unwrap();
    let seen_px = navigator.camera().pixel_at_depth_m(depth_m);
    assert!((seen_px / zoomed_px - 1.0).abs() < 0.01, "{seen_px} {zoomed_px}");
}
