//! The first view shows all the data next to the panel.

use corniche_geom::Bounds;
use corniche_viewer::camera::WorldBox;

use super::*;

#[test]
fn the_first_view_shows_all_the_data_beside_the_panel() {
    let plan = Bounds { min_x: 0.0, min_y: 0.0, max_x: 30_000.0, max_y: 10_000.0 };
    let subject = WorldBox::new(plan, [400.0, 2500.0]);
    let oblique = Orientation { heading_deg: 0.0, pitch_deg: 45.0 };
    for ([width, height], part) in [([1280, 800], 980), ([640, 480], 340), ([400, 300], 400)] {
        let framing = Camera::framing(subject, oblique, [part, height]);
        let camera = in_left_part(&framing, oblique, width).camera([width, height]);
        for corner in subject.corners() {
            let (at_px, _) = camera.project(corner).unwrap();
            assert!((0.0..=f64::from(part)).contains(&at_px.x), "{at_px}");
            assert!((0.0..=f64::from(height)).contains(&at_px.y), "{at_px}");
        }
    }
}

#[test]
fn without_a_panel_the_first_view_is_that_of_a_picture_to_the_last_bit() {
    let plan =
        Bounds { min_x: 513_402.3, min_y: 5_039_817.9, max_x: 519_633.1, max_y: 5_046_488.7 };
    for step in 0..200 {
        let up = f64::from(step) * 0.37;
        let subject = WorldBox::new(plan, [up, 328.1 + up]);
        let orientation = Orientation { heading_deg: 7.3 * up, pitch_deg: 45.0 };
        let picture = Camera::framing(subject, orientation, [640, 400]);
        assert_eq!(in_left_part(&picture, orientation, 640).camera([640, 400]), picture);
    }
}
