//! The near plane does not reach the ground below the eye.

use glam::DVec3;

use super::*;
use crate::camera::{Camera, Orientation};

#[test]
fn the_focus_is_where_the_middle_of_the_picture_meets_level_ground() {
    for (above_m, pitch_deg, expected_m) in [
        (100.0, 0.0, 100.0),
        (100.0, 60.0, 200.0),
        (100.0, 90.0, 500.0),
        (0.1, 0.0, 1.0),
        (-50.0, 30.0, 1.0),
    ] {
        let focus_m = focus_m(above_m, pitch_deg);
        assert!((focus_m - expected_m).abs() < 1e-9, "{above_m} {pitch_deg}: {focus_m}");
    }
}

#[test]
fn the_near_plane_does_not_reach_the_ground() {
    for pitch_deg in [0.0, 45.0, 85.0, 90.0] {
        for above_m in [clearance_m(1.0), 10.0, 1e4, 1e7] {
            let orientation = Orientation { heading_deg: 0.0, pitch_deg };
            let focus_m = focus_m(above_m, pitch_deg);
            let camera = Camera::look_at(DVec3::ZERO, focus_m, orientation, [100, 100]);
            // The corners of the near plane are less than twice as far away as the plane.
            assert!(2.0 * camera.near_m < above_m / 10.0, "{pitch_deg} {above_m}");
        }
    }
}
