//! The map cannot be lost: the data stays in view, also on the way to a place.

use super::*;

/// Whether the middle part of the image shows some of the data, or of a rim of 500 m around it. The
/// search goes pixel by pixel, and a sliver of the data may fall between two pixels.
fn finds_data(navigator: &Navigator) -> bool {
    let view = navigator.view();
    let camera = navigator.camera();
    (0..80).any(|k| {
        (0..80).any(|l| {
            let at_px = DVec2::new(
                160.0 + 480.0 * f64::from(k) / 79.0,
                120.0 + 360.0 * f64::from(l) / 79.0,
            );
            let at = view.on_plane(at_px, camera.size_px, 400.0, 1e6);
            at.is_some_and(|at| {
                (-500.0..=10_500.0).contains(&at.x) && (-500.0..=10_500.0).contains(&at.y)
            })
        })
    })
}

#[test]
fn no_movement_of_the_map_loses_the_data() {
    let mut navigator = looking(30.0, 60.0, 8000.0);
    navigator.has_inertia = false;
    let keys = [
        CameraKey::Left,
        CameraKey::Up,
        CameraKey::Right,
        CameraKey::Down,
        CameraKey::ZoomOut,
        CameraKey::ZoomIn,
    ];
    let mut now_s = 0.0;
    let mut blocked = 0;
    for round in 0..24 {
        // A long way in one direction, with turns and zooms between.
        for step in 0..30 {
            now_s += 0.1;
            let before = navigator.view();
            let is_shifted = step % 7 == 6;
            navigator.handle(&key(keys[round % 6], true, is_shifted), now_s, &FLAT);
            navigator.advance(now_s + 0.05, &FLAT);
            assert!(finds_data(&navigator), "round {round}, step {step}: {:?}", navigator.view());
            blocked += usize::from(navigator.view() == before);
        }
    }
    assert!(blocked > 100, "the way was long enough to lose the data: {blocked}");
}

#[test]
fn a_map_dragged_out_of_the_data_comes_back_with_the_cursor() {
    let mut navigator = looking(0.0, 0.0, 4000.0);
    let grabbed = DVec3::new(5000.0, 5000.0, 400.0);
    navigator.handle(&press(Button::Left, 400.0, 300.0), 0.0, &FLAT);
    for (step, y) in [2000.0, 4000.0, 9000.0].into_iter().enumerate() {
        navigator.handle(&to(400.0, y), 0.1 * (step as f64), &FLAT);
        assert!(finds_data(&navigator), "at {y}");
    }
    navigator.handle(&to(400.0, 350.0), 0.5, &FLAT);
    assert!(off_px(&navigator, grabbed, 400.0, 350.0) < 0.5);
}

#[test]
fn a_flight_may_leave_the_data_and_the_map_goes_on_from_there() {
    let mut navigator = looking(0.0, 60.0, 2000.0);
    navigator.handle(&Input::ToggleFly, 0.0, &FLAT);
    navigator.jump_to(CameraView {
        eye_in_world: DVec3::new(5000.0, 14_000.0, 900.0),
        ..navigator.view()
    });
    navigator.handle(&Input::ToggleFly, 0.1, &FLAT);
    assert!(!finds_data(&navigator));
    let before = navigator.view();
    navigator.handle(&press(Button::Right, 400.0, 300.0), 0.2, &FLAT);
    navigator.handle(&to(500.0, 300.0), 0.3, &FLAT);
    assert!(navigator.view() != before, "it still turns");
    navigator.handle(&Input::Reset, 0.4, &FLAT);
    rest(&mut navigator, 0.4, &FLAT);
    assert!(finds_data(&navigator));
}

#[test]
fn a_place_is_seen_in_the_middle_from_as_far_as_before() {
    let mut navigator = looking(40.0, 55.0, 3000.0);
    let target_in_world = DVec3::new(2000.0, 7000.0, HILLY.at(2000.0, 7000.0));
    let distance_m = |navigator: &Navigator| {
        let eye = navigator.view().eye_in_world;
        let middle = navigator.view().ground_at(DVec2::new(400.0, 300.0), SIZE_PX, 4e4, &HILLY);
        middle.unwrap().distance(eye)
    };
    let before_m = distance_m(&navigator);
    navigator.handle(&Input::GoTo { target_in_world }, 1.0, &HILLY);
    rest(&mut navigator, 1.0, &HILLY);
    assert!(off_px(&navigator, target_in_world, 400.0, 300.0) < 0.01);
    let found_m = navigator.view().eye_in_world.distance(target_in_world);
    assert!((found_m - before_m).abs() < 1e-6 * before_m, "{found_m} m, not {before_m} m");
    let Orientation { heading_deg, pitch_deg } = navigator.view().orientation;
    assert!((heading_deg - 40.0).abs() < 1e-9 && (pitch_deg - 55.0).abs() < 1e-9);
}
