//! The references detect errors: each wrong drawing fails the gate that the correct one passes.

use corniche_viewer::{Caps, RoadMethod, RoadOptions, camera::Camera};
use glam::DVec2;

use super::{
    ground_rays,
    reference::DepthOracle,
    support::{
        Drawing, gpu,
        scene::Scene,
        scenes::{Road, camera, hills, lanes, one_tile, style, tagged, with_own_widths},
    },
};

const SV: RoadMethod = RoadMethod::ShadowVolumes;

fn roads() -> Vec<Road> {
    vec![
        (2, vec![[-500.0, -310.0], [50.0, 20.0], [-60.0, 400.0]]),
        (5, vec![[-500.0, 310.0], [450.0, -120.0]]),
    ]
}

fn true_scene() -> Scene {
    one_tile(8, hills, &roads(), style(40.0))
}

fn view() -> Camera {
    camera(400.0, 1600.0, 25.0, 40.0)
}

/// The disagreements of a drawing with the true scene: by O1 outside 0.05 px, by O2 outside half a
/// pixel.
fn disagreements(drawing: &Drawing) -> [usize; 2] {
    let (scene, camera, options) = (true_scene(), view(), RoadOptions::for_method(SV));
    let found =
        DepthOracle { scene: &scene, camera: &camera, options, drawing, band_px: 0.05 }.compare();
    assert!(found.compared > 3000);
    [found.wrong, ground_rays::compare(&scene, &camera, options, drawing).1]
}

fn check(wrong: &Scene, options: RoadOptions, what: &str) {
    let Some(gpu) = gpu() else { return };
    let right = true_scene().draw(&gpu, &view(), RoadOptions::for_method(SV));
    assert_eq!(disagreements(&right), [0, 0], "the true scene passes");
    let drawing = wrong.draw(&gpu, &view(), options);
    let found = disagreements(&drawing);
    println!("must fail, {what}: {} by depth, {} by rays", found[0], found[1]);
    assert!(found[0] > 20, "{what}: {found:?}");
}

#[test]
fn roads_shifted_by_three_tenths_of_a_pixel_fail() {
    let by = DVec2::ONE.normalize() * 0.3 * view().pixel_at_unit_depth_m() * 1600.0;
    let mut shifted = roads();
    for [x, y] in shifted.iter_mut().flat_map(|(_, points)| points) {
        (*x, *y) = (*x + by.x, *y + by.y);
    }
    check(
        &one_tile(8, hills, &shifted, style(40.0)),
        RoadOptions::for_method(SV),
        "shifted 0.3 px",
    );
}

#[test]
fn roads_five_percent_wider_fail() {
    check(&one_tile(8, hills, &roads(), style(42.0)), RoadOptions::for_method(SV), "5 % wider");
}

#[test]
fn roads_without_their_caps_fail() {
    let options = RoadOptions { caps: Caps::None, ..RoadOptions::for_method(SV) };
    check(&true_scene(), options, "caps dropped");
}

#[test]
fn roads_with_classes_swapped_fail() {
    let mut swapped = roads();
    (swapped[0].0, swapped[1].0) = (5, 2);
    check(
        &one_tile(8, hills, &swapped, style(40.0)),
        RoadOptions::for_method(SV),
        "classes swapped",
    );
}

#[test]
fn roads_of_their_own_width_fail_where_classes_decide() {
    let own = with_own_widths(&true_scene(), &[tagged(38_000), lanes(12)]);
    check(&own, RoadOptions::for_method(SV), "5 % narrower by a tag");
    let not_looked_at = Scene { style: style(40.0), ..own };
    let Some(gpu) = gpu() else { return };
    let drawing = not_looked_at.draw(&gpu, &view(), RoadOptions::for_method(SV));
    assert_eq!(disagreements(&drawing), [0, 0], "tags that the style ignores");
}

#[test]
fn a_road_left_out_fails() {
    check(
        &one_tile(8, hills, &roads()[..1], style(40.0)),
        RoadOptions::for_method(SV),
        "a road omitted",
    );
}
