//! The grabbed ground stays under the cursor, and the eye never leaves the world.

use corniche_geom::Bounds;
use proptest::prelude::*;

use super::*;

#[path = "above_tests.rs"]
mod above_tests;
#[path = "keeping_tests.rs"]
mod keeping;

const SIZE_PX: [u32; 2] = [800, 600];

/// Hills of ±`rise_m` around 400 m.
struct Hills {
    rise_m: f64,
}

impl Hills {
    fn at(&self, x: f64, y: f64) -> f64 {
        400.0 + self.rise_m * (x / 700.0).sin() * (y / 900.0).cos()
    }
}

impl KnownGround for Hills {
    /// Searches in steps of a hundredth of the way, then by bisection.
    fn hit(&self, eye: DVec3, ray: DVec3) -> Option<DVec3> {
        let above = |depth: f64| {
            let at = eye + ray * depth;
            at.z - self.at(at.x, at.y)
        };
        let (mut near, mut far) = (0.0, 1.0);
        while above(far) > 0.0 {
            (near, far) = (far, far * 1.01 + 1.0);
            if far > 1e6 {
                return None;
            }
        }
        for _ in 0..80 {
            let middle = f64::midpoint(near, far);
            if above(middle) > 0.0 { near = middle } else { far = middle }
        }
        Some(eye + ray * near)
    }

    fn height(&self, [x, y]: [f64; 2]) -> Option<f64> {
        Some(self.at(x, y))
    }

    fn base_height(&self) -> f64 {
        400.0
    }

    fn heights(&self) -> [f64; 2] {
        [400.0 - self.rise_m, 400.0 + self.rise_m]
    }
}

const FLAT: Hills = Hills { rise_m: 0.0 };
const HILLY: Hills = Hills { rise_m: 250.0 };

fn looking(heading_deg: f64, pitch_deg: f64, distance_m: f64) -> Navigator {
    let orientation = Orientation { heading_deg, pitch_deg };
    let target = DVec3::new(5000.0, 5000.0, 400.0);
    let camera = Camera::look_at(target, distance_m, orientation, SIZE_PX);
    let limits = CameraLimits {
        data: Bounds { min_x: 0.0, min_y: 0.0, max_x: 10_000.0, max_y: 10_000.0 },
        clearance_m: 2.0,
        max_pitch_deg: 85.0,
    };
    Navigator::new(CameraView::from_camera(&camera, orientation), limits, SIZE_PX, true)
}

fn press(button: Button, x: f64, y: f64) -> Input {
    Input::Press { button, at_px: DVec2::new(x, y), modifiers: Modifiers::default() }
}

fn to(x: f64, y: f64) -> Input {
    Input::Move { at_px: DVec2::new(x, y) }
}

fn key(key: CameraKey, is_down: bool, shift: bool) -> Input {
    Input::Key { key, is_down, modifiers: Modifiers { shift, control: false } }
}

/// Advances the time until nothing moves; panics if something moves for a minute.
fn rest(navigator: &mut Navigator, from_s: f64, ground: &Hills) {
    let mut now_s = from_s;
    while navigator.is_moving() {
        now_s += 1.0 / 60.0;
        navigator.advance(now_s, ground);
        assert!(now_s < from_s + 60.0, "still moving");
    }
}

/// The distance in pixels between a place in the world and a pixel of the image.
fn off_px(navigator: &Navigator, at_in_world: DVec3, x: f64, y: f64) -> f64 {
    let (seen, _) = navigator.camera().project(at_in_world).expect("in front of the eye");
    seen.distance(DVec2::new(x, y))
}

proptest! {
    #[test]
    fn the_ground_grabbed_stays_under_the_cursor(
        heading_deg in -180.0..180.0_f64,
        pitch_deg in 0.0..65.0_f64,
        distance_m in 900.0..8000.0_f64,
        [x, y] in [50.0..750.0_f64, 250.0..590.0_f64],
        way in prop::collection::vec([-40.0..40.0_f64, -25.0..25.0_f64], 1..12),
    ) {
        let mut navigator = looking(heading_deg, pitch_deg, distance_m);
        let grabbed = navigator.view().ground_at(DVec2::new(x, y), SIZE_PX, 4e4, &HILLY).unwrap();
        navigator.handle(&press(Button::Left, x, y), 0.0, &HILLY);
        let (mut x, mut y) = (x, y);
        for ([dx, dy], step) in way.into_iter().zip(1..) {
            (x, y) = (x + dx, (y + dy).max(240.0));
            navigator.handle(&to(x, y), f64::from(step) / 60.0, &HILLY);
            prop_assert!(off_px(&navigator, grabbed, x, y) <= 0.5);
        }
    }

    #[test]
    fn the_ground_between_two_fingers_stays_there(
        heading_deg in -180.0..180.0_f64,
        pitch_deg in 0.0..65.0_f64,
        [x, y] in [250.0..550.0_f64, 350.0..450.0_f64],
        apart in 60.0..120.0_f64,
        way in prop::collection::vec([-25.0..25.0_f64, -15.0..15.0_f64, -0.3..0.3_f64, 0.9..1.12_f64], 1..8),
    ) {
        let mut navigator = looking(heading_deg, pitch_deg, 4000.0);
        let between = DVec2::new(x, y);
        let grabbed = navigator.view().ground_at(between, SIZE_PX, 4e4, &HILLY).unwrap();
        let arm = DVec2::new(apart, 0.0);
        navigator.handle(&Input::TwoFingers { at_px: [between - arm, between + arm] }, 0.0, &HILLY);
        // First a pinch, so that the following movement is not a tilt.
        let (mut between, mut arm) = (between, arm * 1.3);
        navigator.handle(&Input::TwoFingers { at_px: [between - arm, between + arm] }, 0.0, &HILLY);
        for ([dx, dy, angle, factor], step) in way.into_iter().zip(1..) {
            between += DVec2::new(dx, dy);
            arm = DVec2::from_angle(angle).rotate(arm) * factor;
            let input = Input::TwoFingers { at_px: [between - arm, between + arm] };
            navigator.handle(&input, f64::from(step) / 60.0, &HILLY);
            prop_assert!(off_px(&navigator, grabbed, between.x, between.y) <= 0.5);
        }
    }

    #[test]
    fn the_ground_under_the_wheel_stays_there(
        heading_deg in -180.0..180.0_f64,
        pitch_deg in 0.0..65.0_f64,
        [x, y] in [50.0..750.0_f64, 250.0..590.0_f64],
        steps in -3.0..6.0_f64,
    ) {
        let mut navigator = looking(heading_deg, pitch_deg, 5000.0);
        let seen = navigator.view().ground_at(DVec2::new(x, y), SIZE_PX, 4e4, &HILLY).unwrap();
        navigator.handle(&Input::Wheel { steps, at_px: DVec2::new(x, y) }, 0.0, &HILLY);
        rest(&mut navigator, 0.0, &HILLY);
        prop_assert!(off_px(&navigator, seen, x, y) <= 0.5);
    }

    #[test]
    fn the_ground_grabbed_with_the_wheel_button_stays_while_turning(
        heading_deg in -180.0..180.0_f64,
        [x, y] in [50.0..750.0_f64, 250.0..590.0_f64],
        [dx, dy] in [-300.0..300.0_f64, 0.0..60.0_f64],
    ) {
        let mut navigator = looking(heading_deg, 40.0, 5000.0);
        let pivot = navigator.view().ground_at(DVec2::new(x, y), SIZE_PX, 4e4, &HILLY).unwrap();
        navigator.handle(&press(Button::Middle, x, y), 0.0, &HILLY);
        navigator.handle(&to(x + dx, y + dy), 0.1, &HILLY);
        prop_assert!(off_px(&navigator, pivot, x, y) <= 0.5);
        let turned_deg = half_turn(navigator.view().orientation.heading_deg - heading_deg);
        prop_assert!((turned_deg - half_turn(0.8 * dx)).abs() < 1e-9);
        prop_assert!((navigator.view().orientation.pitch_deg - (40.0 - 0.5 * dy)).abs() < 1e-9);
    }

    /// Whatever the user does, the eye stays finite, above the ground and near the data, and the
    /// tilt in its range.
    #[test]
    fn the_eye_never_leaves_the_world(
        inputs in prop::collection::vec((0..12_u8, -200.0..1000.0_f64, -200.0..800.0_f64), 1..60),
    ) {
        let mut navigator = looking(20.0, 50.0, 2000.0);
        let buttons = [Button::Left, Button::Middle, Button::Right];
        let keys = [CameraKey::Up, CameraKey::Left, CameraKey::ZoomIn, CameraKey::Ahead, CameraKey::Sink, CameraKey::Rise, CameraKey::Back];
        let mut now_s = 0.0;
        for (what, x, y) in inputs {
            let pick = (x.abs() as usize) % 21;
            let input = match what {
                0..=1 => press(buttons[pick % 3], x, y),
                2..=4 => to(x, y),
                5 => Input::Release { button: buttons[pick % 3] },
                6 => Input::Wheel { steps: y / 40.0, at_px: DVec2::new(x, 300.0) },
                7 => key(keys[pick % 7], true, y > 300.0),
                8 => key(keys[pick % 7], false, false),
                9 => Input::ToggleFly,
                10 => Input::ToggleAbove,
                _ => Input::NorthUp,
            };
            navigator.handle(&input, now_s, &HILLY);
            now_s += 0.05;
            navigator.advance(now_s, &HILLY);
            let CameraView { eye_in_world: eye, orientation, focus_m, .. } = navigator.view();
            prop_assert!(eye.is_finite() && focus_m.is_finite() && focus_m > 0.0);
            prop_assert!(eye.z >= HILLY.at(eye.x, eye.y) + 2.0 - 1e-6, "{input:?}");
            prop_assert!((0.0..=90.0).contains(&orientation.pitch_deg));
            prop_assert!(eye.truncate().distance(DVec2::splat(5000.0)) < 5e4);
            prop_assert!(eye.z < 5e4);
        }
    }
}

/// Three metres above a slope that rises behind the eye.
fn before_a_slope() -> Navigator {
    let mut navigator = looking(270.0, 70.0, 300.0);
    let [x, y] = [4740.0, 5000.0];
    let eye_in_world = DVec3::new(x, y, HILLY.at(x, y) + 3.0);
    navigator.jump_to(CameraView { eye_in_world, ..navigator.view() });
    navigator
}

#[test]
fn the_eye_is_lifted_over_a_hill_and_the_grabbed_ground_stays() {
    let mut navigator = before_a_slope();
    let before_m = navigator.view().eye_in_world.z;
    let (x, mut y) = (400.0, 500.0);
    let grabbed = navigator.view().ground_at(DVec2::new(x, y), SIZE_PX, 4e4, &HILLY).unwrap();
    navigator.handle(&press(Button::Left, x, y), 0.0, &HILLY);
    // The map is pushed away, so that the eye runs backwards into the hill.
    while y > 260.0 {
        y -= 20.0;
        navigator.handle(&to(x, y), 1.0, &HILLY);
        assert!(off_px(&navigator, grabbed, x, y) <= 0.5, "at {y}");
    }
    assert!(navigator.view().lacks_m(2.0, &HILLY) <= 1e-6);
    let there = navigator.view().eye_in_world;
    assert!(there.z > before_m + 0.5, "it was never in the way");
    // Along an endless slope, the grabbed ground cannot be seen there from any position.
    let mut navigator = before_a_slope();
    let before = navigator.view();
    navigator.handle(&press(Button::Left, 400.0, 500.0), 0.0, &Slope);
    navigator.handle(&to(400.0, 250.0), 0.1, &Slope);
    assert_eq!(navigator.view().eye_in_world, before.eye_in_world);
}

/// A slope that rises to the east forever, one in three, through the ground beneath that navigator.
struct Slope;

impl KnownGround for Slope {
    fn hit(&self, eye: DVec3, ray: DVec3) -> Option<DVec3> {
        let depth = (self.height([eye.x, eye.y])? - eye.z) / (ray.z - ray.x / 3.0);
        (depth > 0.0).then(|| eye + ray * depth)
    }

    fn height(&self, [x, _]: [f64; 2]) -> Option<f64> {
        Some(HILLY.at(4740.0, 5000.0) + (x - 4740.0) / 3.0)
    }

    fn base_height(&self) -> f64 {
        400.0
    }

    fn heights(&self) -> [f64; 2] {
        [400.0; 2]
    }
}

#[test]
fn tilting_ends_at_the_ground_and_what_is_turned_about_stays() {
    let mut navigator = before_a_slope();
    let middle = navigator.view().ground_at(DVec2::new(400.0, 300.0), SIZE_PX, 4e4, &HILLY);
    let before_m = navigator.view().eye_in_world.z;
    navigator.handle(&press(Button::Right, 400.0, 300.0), 0.0, &HILLY);
    navigator.handle(&to(400.0, 275.0), 0.1, &HILLY);
    assert!(off_px(&navigator, middle.unwrap(), 400.0, 300.0) <= 0.5);
    assert!(
        (navigator.view().eye_in_world.z - before_m).abs() < 1e-6,
        "82.5° would be in the hill"
    );
    navigator.handle(&to(400.0, 325.0), 0.2, &HILLY);
    assert!(navigator.view().orientation.pitch_deg < 60.0, "back it goes");
}

/// No ground anywhere.
struct Void;

impl KnownGround for Void {
    fn hit(&self, _: DVec3, _: DVec3) -> Option<DVec3> {
        None
    }

    fn height(&self, _: [f64; 2]) -> Option<f64> {
        None
    }

    fn base_height(&self) -> f64 {
        400.0
    }

    fn heights(&self) -> [f64; 2] {
        [400.0; 2]
    }
}

#[test]
fn zooming_in_over_a_void_ends_above_the_plane_that_stands_in() {
    let mut navigator = looking(0.0, 30.0, 3000.0);
    for step in 0..200 {
        let now_s = f64::from(step) * 0.1;
        navigator.handle(
            &Input::Wheel { steps: 3.0, at_px: DVec2::new(300.0, 200.0) },
            now_s,
            &Void,
        );
        navigator.advance(now_s + 0.05, &Void);
    }
    let above_m = navigator.view().eye_in_world.z - 400.0;
    assert!((3.0..100.0).contains(&above_m), "{above_m}");
}

#[test]
fn a_right_drag_turns_about_the_middle() {
    let mut navigator = looking(10.0, 40.0, 3000.0);
    navigator.handle(&press(Button::Right, 100.0, 100.0), 0.0, &FLAT);
    navigator.handle(&to(150.0, 80.0), 0.1, &FLAT);
    let Orientation { heading_deg, pitch_deg } = navigator.view().orientation;
    assert!((heading_deg - 50.0).abs() < 1e-9 && (pitch_deg - 50.0).abs() < 1e-9);
    assert!(off_px(&navigator, DVec3::new(5000.0, 5000.0, 400.0), 400.0, 300.0) < 1e-6);
}

#[test]
fn control_and_the_left_button_turn_as_the_right_one_does() {
    let mut navigator = looking(10.0, 40.0, 3000.0);
    let modifiers = Modifiers { shift: false, control: true };
    let at_px = DVec2::new(100.0, 100.0);
    navigator.handle(&Input::Press { button: Button::Left, at_px, modifiers }, 0.0, &FLAT);
    navigator.handle(&to(150.0, 80.0), 0.1, &FLAT);
    assert!((navigator.view().orientation.heading_deg - 50.0).abs() < 1e-9);
}

#[test]
fn a_map_thrown_glides_on_and_one_put_down_stays() {
    let drag = |inertia, pause_s: f64| {
        let mut navigator = looking(0.0, 30.0, 3000.0);
        navigator.has_inertia = inertia;
        navigator.handle(&press(Button::Left, 400.0, 300.0), 0.0, &FLAT);
        for step in 1..=10 {
            let x = 400.0 + 10.0 * f64::from(step);
            navigator.handle(&to(x, 300.0), f64::from(step) / 60.0, &FLAT);
        }
        let released_s = 10.0 / 60.0 + pause_s;
        navigator.handle(&Input::Release { button: Button::Left }, released_s, &FLAT);
        let before = navigator.view().eye_in_world;
        rest(&mut navigator, released_s, &FLAT);
        navigator.view().eye_in_world.x - before.x
    };
    let glided_m = drag(true, 0.0);
    assert!(glided_m < -50.0, "the map goes on to the right, the eye to the left: {glided_m}");
    assert!(drag(true, 0.3).abs() < 1e-9, "the hand rested");
    assert!(drag(false, 0.0).abs() < 1e-9, "nothing is to glide");
}

#[test]
fn a_map_is_thrown_where_frames_are_slow_too() {
    let drag = |moves: &[(f64, f64)]| {
        let mut navigator = looking(0.0, 30.0, 3000.0);
        navigator.has_inertia = true;
        navigator.handle(&press(Button::Left, 400.0, 300.0), 0.0, &FLAT);
        let mut last_s = 0.0;
        for (now_s, x) in moves {
            navigator.handle(&to(*x, 300.0), *now_s, &FLAT);
            last_s = *now_s;
        }
        navigator.handle(&Input::Release { button: Button::Left }, last_s, &FLAT);
        navigator.is_moving()
    };
    assert!(drag(&[(0.2, 500.0), (0.4, 600.0), (0.6, 700.0)]));
    assert!(!drag(&[(0.2, 700.0), (1.4, 702.0)]), "before its last step the hand rested");
}

#[test]
fn signs_zoom_by_a_level_and_with_shift_by_two() {
    let target = DVec3::new(5000.0, 5000.0, 400.0);
    for (sign, shift, factor) in [
        (CameraKey::ZoomIn, false, 0.5),
        (CameraKey::ZoomIn, true, 0.25),
        (CameraKey::ZoomOut, false, 2.0),
        (CameraKey::ZoomOut, true, 4.0),
    ] {
        let mut navigator = looking(0.0, 30.0, 3000.0);
        navigator.handle(&key(sign, true, shift), 0.0, &FLAT);
        rest(&mut navigator, 0.0, &FLAT);
        let distance_m = navigator.view().eye_in_world.distance(target);
        assert!((distance_m / 3000.0 / factor - 1.0).abs() < 0.005, "{distance_m}");
    }
}

#[test]
fn shift_makes_a_flight_under_way_fast_and_slow_again() {
    let mut navigator = looking(90.0, 85.0, 3000.0);
    navigator.handle(&Input::ToggleFly, 0.0, &FLAT);
    navigator.handle(&key(CameraKey::StrafeLeft, true, false), 0.0, &FLAT);
    let mut now_s = 0.0;
    let mut way_m = |shift: bool| {
        let modifiers = Modifiers { shift, control: false };
        navigator.handle(&Input::Modify { modifiers }, now_s, &FLAT);
        let from = navigator.view().eye_in_world;
        now_s += 0.05;
        navigator.advance(now_s, &FLAT);
        navigator.view().eye_in_world.distance(from)
    };
    // The focus of the first view determines the first step.
    way_m(false);
    let [slow_m, fast_m, again_m] = [false, true, false].map(&mut way_m);
    assert!((fast_m / slow_m - 4.0).abs() < 1e-6, "{slow_m} m became {fast_m} m");
    assert!((again_m / slow_m - 1.0).abs() < 1e-6);
}

#[test]
fn a_double_click_halves_the_distance_and_doubles_it_with_shift() {
    let check = |shift, factor: f64| {
        let mut navigator = looking(0.0, 30.0, 3000.0);
        let modifiers = Modifiers { shift, control: false };
        let at_px = DVec2::new(400.0, 300.0);
        navigator.handle(&Input::DoubleClick { at_px, modifiers }, 0.0, &FLAT);
        rest(&mut navigator, 0.0, &FLAT);
        let target = DVec3::new(5000.0, 5000.0, 400.0);
        let distance_m = navigator.view().eye_in_world.distance(target);
        assert!((distance_m / 3000.0 - factor).abs() < 0.002, "{distance_m}");
    };
    check(false, 0.5);
    check(true, 2.0);
}

#[test]
fn arrows_pan_by_a_hundred_pixels_and_turn_with_shift() {
    let mut navigator = looking(90.0, 0.0, 3000.0);
    let pixel_m = navigator.camera().pixel_at_unit_depth_m() * 3000.0;
    navigator.handle(&key(CameraKey::Up, true, false), 0.0, &FLAT);
    rest(&mut navigator, 0.0, &FLAT);
    // In an image that looks east, up is east.
    let eye = navigator.view().eye_in_world;
    assert!((eye.x - 5000.0 - 100.0 * pixel_m).abs() < 1e-3 * pixel_m + 1e-6, "{eye}");
    assert!((eye.y - 5000.0).abs() < 1e-6);
    navigator.handle(&key(CameraKey::Right, true, true), 1.0, &FLAT);
    navigator.handle(&key(CameraKey::Up, true, true), 1.0, &FLAT);
    rest(&mut navigator, 1.0, &FLAT);
    let Orientation { heading_deg, pitch_deg } = navigator.view().orientation;
    assert!((heading_deg - 105.0).abs() < 0.01 && (pitch_deg - 10.0).abs() < 0.01);
}

#[test]
fn north_comes_up_the_shorter_way_and_reset_returns() {
    let mut navigator = looking(200.0, 30.0, 3000.0);
    let home = navigator.view();
    navigator.handle(&Input::NorthUp, 0.0, &FLAT);
    navigator.advance(0.02, &FLAT);
    let heading_deg = navigator.view().orientation.heading_deg;
    assert!((-160.0..-100.0).contains(&half_turn(heading_deg)), "{heading_deg}");
    rest(&mut navigator, 0.02, &FLAT);
    assert!(navigator.view().orientation.heading_deg.abs() < 1e-2);
    assert!((navigator.view().orientation.pitch_deg - 30.0).abs() < 1e-9);
    navigator.handle(&Input::Reset, 5.0, &FLAT);
    rest(&mut navigator, 5.0, &FLAT);
    assert!(navigator.view().eye_in_world.distance(home.eye_in_world) < 1e-9);
    assert_eq!(navigator.view().orientation, home.orientation);
}

#[test]
fn in_fly_mode_the_eye_moves_along_its_view_while_a_key_is_held() {
    let mut navigator = looking(90.0, 90.0, 3000.0);
    navigator.jump_to(CameraView {
        eye_in_world: DVec3::new(4000.0, 5000.0, 900.0),
        ..navigator.view()
    });
    navigator.handle(&Input::ToggleFly, 0.0, &FLAT);
    assert_eq!(navigator.mode, Mode::Fly);
    let start = navigator.view().eye_in_world;
    navigator.handle(&key(CameraKey::Ahead, true, false), 0.0, &FLAT);
    for step in 1..=10 {
        navigator.advance(f64::from(step) * 0.05, &FLAT);
    }
    let there = navigator.view();
    assert!(there.eye_in_world.x > start.x + 100.0, "east is ahead");
    // Map mode tilts no farther than 85°, so that it sinks a little on its way.
    let moved = there.eye_in_world - start;
    assert!((moved.z / moved.x + 5.0_f64.to_radians().tan()).abs() < 1e-9);
    navigator.handle(&key(CameraKey::Ahead, false, false), 0.5, &FLAT);
    assert!(!navigator.is_moving());
    // The left button looks around, and the eye stays.
    navigator.handle(&press(Button::Left, 400.0, 300.0), 0.6, &FLAT);
    navigator.handle(&to(300.0, 320.0), 0.7, &FLAT);
    let Orientation { heading_deg, pitch_deg } = navigator.view().orientation;
    assert!((heading_deg - 105.0).abs() < 1e-9 && (pitch_deg - 88.0).abs() < 1e-9);
    assert_eq!(navigator.view().eye_in_world, there.eye_in_world);
    // A key whose release was never reported does not fly on forever.
    navigator.handle(&key(CameraKey::Rise, true, true), 0.8, &FLAT);
    navigator.handle(&Input::LetGo, 0.9, &FLAT);
    assert!(!navigator.is_moving());
}

#[test]
fn what_is_grabbed_in_the_sky_moves_nothing() {
    let mut navigator = looking(0.0, 85.0, 3000.0);
    let before = navigator.view().eye_in_world;
    navigator.handle(&press(Button::Left, 400.0, 5.0), 0.0, &FLAT);
    navigator.handle(&to(500.0, 50.0), 0.1, &FLAT);
    assert_eq!(navigator.view().eye_in_world, before);
    // Ground is not thrown beyond the horizon either.
    navigator.handle(&press(Button::Left, 400.0, 590.0), 0.2, &FLAT);
    navigator.handle(&to(400.0, 5.0), 0.3, &FLAT);
    assert_eq!(navigator.view().eye_in_world, before);
}

#[test]
fn exaggeration_keeps_the_middle_of_the_picture() {
    let mut navigator = looking(0.0, 50.0, 3000.0);
    let middle = DVec3::new(5000.0, 5000.0, 400.0);
    navigator.rescale_heights(3.0, &FLAT);
    let lifted = DVec3::new(middle.x, middle.y, 1200.0);
    assert!(off_px(&navigator, lifted, 400.0, 300.0) < 1e-6);
}

#[test]
fn a_key_that_repeats_itself_flies_as_far_as_one_that_does_not() {
    let flown_m = |repeats: &[f64]| {
        let mut navigator = looking(0.0, 60.0, 2000.0);
        let ahead = |is_down| Input::Key {
            key: CameraKey::Ahead,
            is_down,
            modifiers: Modifiers::default(),
        };
        navigator.handle(&Input::ToggleFly, 10.0, &FLAT);
        let from = navigator.view().eye_in_world;
        navigator.handle(&ahead(true), 10.0, &FLAT);
        for at_s in repeats {
            navigator.handle(&ahead(true), *at_s, &FLAT);
        }
        navigator.advance(10.4, &FLAT);
        navigator.view().eye_in_world.distance(from)
    };
    let once_m = flown_m(&[]);
    assert!(once_m > 100.0, "{once_m}");
    let repeated_m = flown_m(&[10.25, 10.3, 10.35, 10.399]);
    assert!((once_m - repeated_m).abs() < 1e-6, "{once_m} {repeated_m}");
}

#[test]
fn on_a_screen_twice_as_fine_the_same_way_of_the_hand_turns_as_far() {
    let turned = |pixels_per_point: f64, keyed: CameraKey| {
        let mut navigator = looking(10.0, 40.0, 3000.0);
        navigator.set_pixels_per_point(pixels_per_point);
        navigator.handle(&press(Button::Right, 400.0, 300.0), 0.0, &FLAT);
        let moved = to(400.0 + 30.0 * pixels_per_point, 300.0 + 8.0 * pixels_per_point);
        navigator.handle(&moved, 0.1, &FLAT);
        navigator.handle(&Input::Release { button: Button::Right }, 1.0, &FLAT);
        let from = navigator.view();
        navigator.handle(&key(keyed, true, false), 2.0, &FLAT);
        rest(&mut navigator, 2.0, &FLAT);
        (from.orientation, (navigator.view().eye_in_world - from.eye_in_world).length())
    };
    let ((coarse, way_m), (fine, finer_way_m)) =
        (turned(1.0, CameraKey::Left), turned(2.0, CameraKey::Left));
    assert!((coarse.heading_deg - fine.heading_deg).abs() < 1e-9, "{coarse:?} {fine:?}");
    assert!((coarse.pitch_deg - fine.pitch_deg).abs() < 1e-9, "{coarse:?} {fine:?}");
    // An arrow pans over the same part of the screen, which is twice the number of pixels.
    assert!((finer_way_m / way_m - 2.0).abs() < 0.05, "{way_m} m and {finer_way_m} m");
}

#[test]
fn a_drag_heard_of_after_a_long_frame_is_no_throw_across_the_map() {
    let mut navigator = looking(0.0, 45.0, 3000.0);
    navigator.advance(10.0, &FLAT);
    // A frame takes 1.8 s, and then the whole drag is reported within a millisecond.
    navigator.handle(&press(Button::Left, 400.0, 300.0), 11.8, &FLAT);
    navigator.handle(&to(490.0, 348.0), 11.800_5, &FLAT);
    let from = navigator.view().eye_in_world;
    navigator.handle(&Input::Release { button: Button::Left }, 11.801, &FLAT);
    rest(&mut navigator, 11.801, &FLAT);
    let glided_m = (navigator.view().eye_in_world - from).length();
    assert!(glided_m < 300.0, "{glided_m} m from 3 km away");
}
