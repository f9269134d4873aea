//! The next position of the camera is predicted from its movement, and drags are distinguished from
//! double clicks.

use corniche_geom::Bounds;
use corniche_viewer::camera::Orientation;
use glam::DVec3;

use super::*;
use crate::controls::CameraLimits;

const SIZE_PX: [u32; 2] = [800, 600];

/// Level ground at sea level that no ray hits.
struct Level;

impl KnownGround for Level {
    fn hit(&self, _: DVec3, _: DVec3) -> Option<DVec3> {
        None
    }

    fn height(&self, _: [f64; 2]) -> Option<f64> {
        Some(0.0)
    }

    fn base_height(&self) -> f64 {
        0.0
    }

    fn heights(&self) -> [f64; 2] {
        [0.0; 2]
    }
}

fn view_at(x: f64) -> CameraView {
    let orientation = Orientation { heading_deg: 0.0, pitch_deg: 30.0 };
    CameraView {
        eye_in_world: DVec3::new(x, 500.0, 1000.0),
        orientation,
        focus_m: 1000.0,
        from_above: None,
    }
}

fn control() -> CameraControl {
    let limits = CameraLimits {
        data: Bounds { min_x: 0.0, min_y: 0.0, max_x: 1000.0, max_y: 1000.0 },
        clearance_m: 2.0,
        max_pitch_deg: 85.0,
    };
    CameraControl::new(Navigator::new(view_at(100.0), limits, SIZE_PX, false), 2.0)
}

#[test]
fn a_camera_that_moves_is_expected_half_a_second_further_on() {
    let mut control = control();
    assert!(control.look_ahead(10.0, SIZE_PX).is_none(), "nothing is known of its movement");
    control.navigator.jump_to(view_at(110.0));
    // 10 m in 0.125 s are 40 m in half a second.
    let ahead = control.look_ahead(10.125, SIZE_PX).unwrap().eye_in_world;
    assert!((ahead - DVec3::new(150.0, 500.0, 1000.0)).length() < 1e-6, "{ahead}");
    assert!(control.look_ahead(10.25, SIZE_PX).is_none(), "it stands still");
    assert!((control.at_rest_s(12.125) - 2.0).abs() < 1e-9);
}

#[test]
fn a_jump_after_a_pause_says_nothing_about_the_next_half_second() {
    let mut control = control();
    control.look_ahead(10.0, SIZE_PX);
    control.navigator.jump_to(view_at(200.0));
    assert!(control.look_ahead(10.5, SIZE_PX).is_none());
    assert!(control.at_rest_s(10.5).abs() < 1e-9, "it moved all the same");
}

#[test]
fn a_press_drags_until_the_button_goes_up_and_a_double_click_does_not_drag() {
    let mut control = control();
    let press = |control: &mut CameraControl, x: f64, now_s| {
        let at_px = DVec2::new(x, 100.0);
        control.press(Button::Left, at_px, Modifiers::default(), now_s, &Level);
    };
    let release = Input::Release { button: Button::Left };
    press(&mut control, 100.0, 1.0);
    assert!(control.is_dragging);
    control.input(&release, 1.1, &Level);
    assert!(!control.is_dragging);
    // 10 pixels are 5 points, near enough for a double click.
    press(&mut control, 110.0, 1.2);
    assert!(!control.is_dragging);
    press(&mut control, 300.0, 5.0);
    control.input(&Input::LetGo, 5.1, &Level);
    assert!(!control.is_dragging);
}

#[test]
fn a_pose_has_the_true_height() {
    let pose = control().pose(2.5);
    assert_eq!(pose.eye_m.map(f64::to_bits), [100.0, 500.0, 400.0].map(f64::to_bits));
}
