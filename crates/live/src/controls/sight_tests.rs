//! Some of the data always stays in view.

use corniche_viewer::camera::{Camera, Orientation};

use super::*;

const SIZE_PX: [u32; 2] = [800, 600];
const DATA: Bounds = Bounds { min_x: 0.0, min_y: 0.0, max_x: 1000.0, max_y: 1000.0 };

fn looking_at(x: f64, y: f64, pitch_deg: f64, distance_m: f64) -> CameraView {
    let orientation = Orientation { heading_deg: 0.0, pitch_deg };
    let camera = Camera::look_at(DVec3::new(x, y, 0.0), distance_m, orientation, SIZE_PX);
    CameraView::from_camera(&camera, orientation)
}

/// Half the inner part is 0.6 · tan 22.5° of the distance high: 248.5 m at 1000 m.
#[test]
fn from_above_the_data_are_seen_up_to_the_edge_of_the_inner_part() {
    let sees = |y: f64| sees_data(&looking_at(500.0, y, 0.0, 1000.0), SIZE_PX, DATA, 0.0);
    assert!(sees(500.0) && sees(-248.0) && sees(1248.0));
    assert!(!sees(-249.0) && !sees(1249.0));
}

#[test]
fn in_the_middle_of_large_data_no_corner_need_be_seen() {
    assert!(sees_data(&looking_at(500.0, 500.0, 60.0, 5.0), SIZE_PX, DATA, 0.0));
}

#[test]
fn what_lies_behind_the_eye_is_not_seen() {
    // North of the data and looking north, at the horizon and below it.
    for pitch_deg in [60.0, 85.0, 90.0] {
        assert!(!sees_data(&looking_at(500.0, 3000.0, pitch_deg, 1000.0), SIZE_PX, DATA, 0.0));
        assert!(sees_data(&looking_at(500.0, 10.0, pitch_deg, 1000.0), SIZE_PX, DATA, -100.0));
    }
}
