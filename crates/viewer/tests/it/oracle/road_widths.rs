//! The width of straight roads, by class or of their own, measured as an area of pixels over a
//! length.

use corniche_roads::OwnWidth;
use corniche_styles::{OwnWidths, Style, WidthScaling};
use corniche_testing::some_of;
use corniche_viewer::{
    ClassSet, RoadOptions, WidthGrowth,
    for_tests::{capped_ways, may_be_clamped},
};
use glam::DVec2;

use super::{
    agreement::{METHODS, name_of},
    support::{
        Drawing, World, class, gpu,
        scene::Scene,
        scenes::{self, lanes, one_tile, style, tagged, with_own_widths},
        within,
    },
};

#[test]
fn straight_roads_on_flat_ground_have_their_width_to_a_tenth_of_a_pixel() {
    check_widths(|_| 1.0);
}

/// From the stretch of a circle of true metres: the distance of its two tangents along the road.
#[test]
#[ignore = "slow: many pictures, each pixel by the reference"]
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

/// A road has the width that its tags request: its own, else by its lanes, else by its class; never
/// more than 60 m.
#[test]
fn straight_roads_are_as_wide_as_their_tags_say() {
    let Some(gpu) = gpu() else { return };
    let camera = scenes::camera(0.0, 300.0, 0.0, 0.0);
    let pixel_m = 300.0 * camera.pixel_at_unit_depth_m();
    let both = Some(OwnWidths { lane_m: Some(3.25) });
    let no_lanes = Some(OwnWidths { lane_m: None });
    let of_class_m = 20.0;
    let cases = [
        (both, tagged(12_000), 12.0),
        (both, tagged(60_000), 60.0),
        (both, tagged(60_001), 60.0),
        (both, tagged(1_000_000), 60.0),
        (both, lanes(4), 13.0),
        (both, lanes(200), 60.0),
        (both, OwnWidth::Unknown, of_class_m),
        (no_lanes, tagged(12_000), 12.0),
        (no_lanes, lanes(4), of_class_m),
        (None, tagged(12_000), of_class_m),
        (None, lanes(4), of_class_m),
    ];
    let direction = DVec2::from_angle(0.7);
    let end = |sign: f64| (direction * sign * 1500.0).to_array();
    let road = (3, vec![end(-1.0), end(1.0)]);
    let plain = one_tile(256, |_, _| 0.0, &[road], style(of_class_m as f32));
    for method in METHODS {
        for (own_widths, own, expected_m) in cases {
            let mut scene = with_own_widths(&plain, &[own]);
            scene.style.own_widths = own_widths;
            let drawing = scene.draw(&gpu, &camera, RoadOptions::for_method(method));
            let measured_px = width_px(&drawing, direction);
            println!(
                "{} {own:?}: {measured_px:.2} px, {:.2} m",
                name_of(method),
                measured_px * pixel_m
            );
            assert!((measured_px - expected_m / pixel_m).abs() < 0.1, "{own:?} {own_widths:?}");
        }
    }
}

/// The width of the road from its pixels in a square window that is aligned with the road: area
/// divided by length.
fn width_px(drawing: &Drawing, direction: DVec2) -> f64 {
    let half_px = 140.0;
    let middle = DVec2::new(f64::from(scenes::SIZE[0]), f64::from(scenes::SIZE[1])) / 2.0;
    // On the picture, y points down.
    let along = DVec2::new(direction.x, -direction.y);
    let pixels = drawing.pixels_of(3);
    let area = pixels.iter().filter(|at| (**at - middle).dot(along).abs() <= half_px).count();
    area as f64 / (2.0 * half_px)
}

/// If a tile limits the width, both methods cut roads of their own width at the same position, and
/// this is reported; as are roads that request more than 60 m.
#[test]
fn own_widths_beyond_the_margin_are_cut_alike_and_told() {
    let Some(gpu) = gpu() else { return };
    let camera = scenes::camera(0.0, 1000.0, 0.0, 0.0);
    let pixel_m = 1000.0 * camera.pixel_at_unit_depth_m();
    let direction = DVec2::from_angle(0.7);
    let end = |sign: f64| (direction * sign * 1500.0).to_array();
    let roads = [(3, vec![end(-1.0), end(1.0)]), (5, vec![end(-0.9), end(-0.8)])];
    let plain = one_tile(256, |_, _| 0.0, &roads, style(20.0));
    let margin_m = plain.tiles[0].geometry.width_margin_m;
    let mut scene = with_own_widths(&plain, &[tagged(70_000), lanes(2)]);
    // With this factor, a road of 60 m extends beyond the margin, and one of 20 m would not.
    let constant = (2.5 * margin_m / 60.0) as f32;
    scene.style.width_scaling = WidthScaling { constant, ..scene.style.width_scaling };
    for method in METHODS {
        let options =
            RoadOptions { width_growth: WidthGrowth::Constant, ..RoadOptions::for_method(method) };
        let drawing = scene.draw(&gpu, &camera, options);
        let measured_px = width_px(&drawing, direction);
        assert!((measured_px - 2.0 * margin_m / pixel_m).abs() < 0.1, "{measured_px} px");
        let told = |style: &Style, options: RoadOptions| {
            let view = Scene::view(&camera, style, options);
            let tile = &scene.tiles[0].geometry;
            (may_be_clamped(tile, &view), capped_ways([tile, tile].into_iter(), &view))
        };
        assert_eq!(told(&scene.style, options), (true, 1));
        assert_eq!(told(&scene.style, RoadOptions::for_method(method)), (false, 1));
        let by_class = Style { own_widths: None, ..scene.style.clone() };
        assert_eq!(told(&by_class, options), (false, 0));
        let classes = ClassSet::ALL.without(class(3));
        assert_eq!(told(&scene.style, RoadOptions { classes, ..options }), (false, 0));
    }
}

/// For a direction, `stretch` returns the drawn width of a road of one metre.
fn check_widths(stretch: impl Fn(DVec2) -> f64) {
    let Some(gpu) = gpu() else { return };
    let camera = scenes::camera(0.0, 1000.0, 0.0, 0.0);
    let pixel_m = 1000.0 * camera.pixel_at_unit_depth_m();
    for method in METHODS {
        let mut worst_px = 0.0_f64;
        for k in some_of(0..100_u32, [8, 4, 1]) {
            // Golden angles and widths from 4 to 24 pixels: no two directions are equal, and none
            // follows the pixel grid.
            let angle = f64::from(k) * 2.399_963_229_728_653;
            let true_px = 4.0 + 0.2 * f64::from(k);
            let direction = DVec2::from_angle(angle);
            let shift = DVec2::new((f64::from(k) * 0.618).fract(), (f64::from(k) * 0.377).fract());
            let end = |sign: f64| (shift * pixel_m * 10.0 + direction * sign * 1500.0).to_array();
            let road = (3, vec![end(-1.0), end(1.0)]);
            let scene = one_tile(256, |_, _| 0.0, &[road], style((true_px * pixel_m) as f32));
            let drawing = scene.draw(&gpu, &camera, RoadOptions::for_method(method));
            let measured_px = width_px(&drawing, direction);
            worst_px = worst_px.max((measured_px - stretch(direction) * true_px).abs());
        }
        println!("{}: width on flat ground off by {worst_px:.3} px at most", name_of(method));
        assert!(worst_px <= 0.1, "{worst_px} px");
    }
}
