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
