//! The width of straight roads, measured as an area of pixels over a length.

use corniche_viewer::RoadOptions;
use glam::DVec2;

use crate::{
    agreement::{METHODS, name_of},
    support::{
        World, gpu,
        scenes::{self, one_tile, style},
        within,
    },
};

#[test]
fn straight_roads_on_flat_ground_have_their_width_to_a_tenth_of_a_pixel() {
    check_widths(|_| 1.0);
}

/// By how a circle of true metres is stretched: two of its tangents along the road are so far apart.
#[test]
fn straight_roads_have_their_true_width_where_working_metres_are_longer_northwards() {
    let scale = DVec2::new(0.8, 1.25);
    let world = World { ratio: 1.25, scale: scale.to_array() };
    within(world, || {
        check_widths(|direction| {
            let normal = direction.perp();
            // The farthest point of the ellipse along the normal.
            (scale * normal).length()
        });
    });
}

/// `stretch` gives, for a direction, the drawn width of a road of one metre.
fn check_widths(stretch: impl Fn(DVec2) -> f64) {
    let Some(gpu) = gpu() else { return };
    let camera = scenes::camera(0.0, 1000.0, 0.0, 0.0);
    let pixel_m = 1000.0 * camera.pixel_at_unit_depth_m();
    for method in METHODS {
        let mut worst_px = 0.0_f64;
        for k in 0..100_u32 {
            // Golden angles and a width from 4 to 24 pixels: no two alike, none along the pixels.
            let angle = f64::from(k) * 2.399_963_229_728_653;
            let true_px = 4.0 + 0.2 * f64::from(k);
            let direction = DVec2::from_angle(angle);
            let shift = DVec2::new((f64::from(k) * 0.618).fract(), (f64::from(k) * 0.377).fract());
            let end = |sign: f64| (shift * pixel_m * 10.0 + direction * sign * 1500.0).to_array();
            let road = (3, vec![end(-1.0), end(1.0)]);
            let scene = one_tile(256, |_, _| 0.0, &[road], style((true_px * pixel_m) as f32));
            let drawing = scene.draw(&gpu, &camera, RoadOptions::of(method));
            // Pixels of the road in a square window turned with the road: area over length. In the
            // picture, y points down.
            let half_px = 140.0;
            let middle = DVec2::new(f64::from(scenes::SIZE[0]), f64::from(scenes::SIZE[1])) / 2.0;
            let along = DVec2::new(direction.x, -direction.y);
            let area = drawing
                .pixels_of(3)
                .iter()
                .filter(|at| (**at - middle).dot(along).abs() <= half_px)
                .count();
            let measured_px = area as f64 / (2.0 * half_px);
            worst_px = worst_px.max((measured_px - stretch(direction) * true_px).abs());
        }
        println!("{}: width on flat ground off by {worst_px:.3} px at most", name_of(method));
        assert!(worst_px <= 0.1, "{worst_px} px");
    }
}
