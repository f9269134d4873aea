//! Views from above with parallel rays: both references agree with the drawing, and a width is the
//! same everywhere.

use corniche_testing::some_of;
use corniche_viewer::{RoadOptions, camera::Camera};
use glam::DVec2;

use super::{
    agreement::{METHODS, check, name_of},
    support::{
        Drawing, gpu,
        scenes::{self, Named, center, hills, one_tile, style},
    },
};

/// All ground of the scenes is between these heights.
const HEIGHTS_M: [f64; 2] = [-3000.0, 6000.0];

fn from_above(pixel_m: f64, heading_deg: f64) -> Camera {
    Camera::from_above(center(), pixel_m, heading_deg, HEIGHTS_M, scenes::SIZE)
}

/// Every scene of roads: bands, tunnels, slip roads, own widths, least widths, crests and cliffs,
/// across tiles.
#[test]
#[ignore = "slow: many pictures, each pixel by two references"]
fn both_methods_agree_with_the_references_in_views_from_above() {
    for named in some_of(scenes::all(), [4, 4, 1]) {
        let cameras = vec![from_above(4.0, 0.0), from_above(1.5, 57.0)];
        check(&Named { cameras, ..named });
    }
}

/// Pixels of the road in a strip across the picture: area over length.
fn width_px(drawing: &Drawing, direction: DVec2, middle_px: DVec2) -> f64 {
    let half_px = 40.0;
    // On the picture, y points down.
    let along = DVec2::new(direction.x, -direction.y);
    let is_in = |at: &&DVec2| (**at - middle_px).dot(along).abs() <= half_px;
    drawing.pixels_of(3).iter().filter(is_in).count() as f64 / (2.0 * half_px)
}

/// On hills of some hundred metres, near the middle of the picture and far from it.
#[test]
fn a_road_of_known_width_is_as_wide_everywhere_in_a_view_from_above() {
    let Some(gpu) = gpu() else { return };
    let (pixel_m, width_m) = (2.0, 30.0);
    let direction = DVec2::from_angle(0.3);
    let end = |sign: f64| (direction * sign * 1500.0).to_array();
    let road = (3, vec![end(-1.0), end(1.0)]);
    let scene = one_tile(4, hills, &[road], style(width_m));
    let camera = from_above(pixel_m, 0.0);
    let middle = DVec2::new(f64::from(scenes::SIZE[0]), f64::from(scenes::SIZE[1])) / 2.0;
    for method in METHODS {
        let drawing = scene.draw(&gpu, &camera, RoadOptions::for_method(method));
        for along_px in [-120.0, 0.0, 120.0] {
            let at = middle + DVec2::new(direction.x, -direction.y) * along_px;
            let found_px = width_px(&drawing, direction, at);
            println!("{} from above, {along_px} px aside: {found_px:.2} px", name_of(method));
            assert!((found_px - f64::from(width_m) / pixel_m).abs() < 0.2, "{found_px} px");
        }
    }
}
