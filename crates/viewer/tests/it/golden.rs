//! Compares drawings with pictures that a person has checked: how ground, roads, edges, haze,
//! wireframe and differences are combined. The oracle checks which pixel shows which road.
//!
//! The pictures are valid for software Vulkan (llvmpipe) only; GPUs differ by more than the
//! tolerance at every edge. `CORNICHE_BLESS=1 cargo test -p corniche-viewer --test it golden`
//! accepts the current drawings. Look at them.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "this is test code, helpers included")]

use crate::support;

use corniche_styles::{RoadBands, Style};
use corniche_testing::pictures::{Golden, is_blessing};
use corniche_viewer::{
    FrameView, RoadMethod, RoadOptions,
    camera::{Camera, Orientation},
    gpu::{Gpu, Picture, Renderer, Targets},
};
use image::RgbaImage;
use support::{
    gpu,
    scene::Scene,
    scenes::{center, hills, junction, one_tile},
};

const SIZE: [u32; 2] = [240, 180];
const METHODS: [RoadMethod; 2] = [RoadMethod::Geometry, RoadMethod::ShadowVolumes];

fn golden() -> Golden {
    Golden::of_crate(env!("CARGO_MANIFEST_DIR"), option_env!("CARGO_TARGET_TMPDIR"))
}

/// The software adapter, or `None` and a message on the terminal.
fn software() -> Option<Gpu> {
    let gpu = gpu()?;
    let is_pinned = ["llvmpipe", "vulkan"].iter().all(|part| gpu.adapter_name.contains(part));
    if !is_pinned {
        corniche_testing::skip(&format!(
            "these pictures are llvmpipe's, not {}'s",
            &gpu.adapter_name
        ));
    }
    is_pinned.then_some(gpu)
}

/// Ground so uneven across the roads that level quads of geometry would miss a part of the roads.
fn steep(x: f64, y: f64) -> f64 {
    400.0 + 40.0 * (x / 60.0).sin() * (y / 75.0).cos()
}

fn camera(distance_m: f64, pitch_deg: f64) -> Camera {
    let orientation = Orientation { heading_deg: 25.0, pitch_deg };
    Camera::look_at(center().extend(400.0), distance_m, orientation, SIZE)
}

fn view<'a>(camera: &'a Camera, style: &'a Style, method: RoadMethod) -> FrameView<'a> {
    let height_range_m = [250.0, 500.0];
    FrameView { height_range_m, ..Scene::view(camera, style, RoadOptions::for_method(method)) }
}

/// A junction of four classes from nearby, with a main road of two colours and edges of two pixels.
fn near(gpu: &Gpu, style: &Style, method: RoadMethod) -> Targets {
    let camera = camera(900.0, 55.0);
    let scene = one_tile(4, steep, &junction(), style.clone());
    scene.draw_view(gpu, &view(&camera, style, method), 1)
}

/// The road atlas with wider roads.
fn near_style() -> Style {
    let mut style = Style { outline_px: 2, ..Style::road_atlas() };
    style.roads.iter_mut().for_each(|road| road.width_m *= 2.0);
    style
}

fn image(gpu: &Gpu, picture: &Picture) -> RgbaImage {
    picture.read_image(gpu).unwrap()
}

#[test]
fn a_junction_looks_as_it_did() {
    let Some(gpu) = software() else { return };
    for (method, name) in METHODS.into_iter().zip(["junction-geo", "junction-sv"]) {
        golden().check(name, &image(&gpu, &near(&gpu, &near_style(), method).picture));
    }
}

#[test]
fn far_ground_and_thin_roads_fade_into_the_haze_as_they_did() {
    let Some(gpu) = software() else { return };
    let (camera, style) = (camera(1800.0, 80.0), Style { haze_reach: 2.0, ..Style::road_atlas() });
    let view = view(&camera, &style, RoadMethod::ShadowVolumes);
    let scene = one_tile(16, hills, &junction(), style.clone());
    let targets = scene.draw_view(&gpu, &view, 2);
    golden().check("haze-sv-2-samples", &image(&gpu, &targets.picture));
}

#[test]
fn a_wireframe_looks_as_it_did() {
    let Some(gpu) = software() else { return };
    let (camera, style) = (camera(2500.0, 30.0), Style::road_atlas());
    let scene = one_tile(64, hills, &junction(), style.clone());
    let view = view(&camera, &style, RoadMethod::Geometry);
    let view = FrameView { is_wireframe: true, ..view };
    golden().check("wireframe", &image(&gpu, &scene.draw_view(&gpu, &view, 1).picture));
}

#[test]
fn the_difference_of_two_methods_looks_as_it_did() {
    let Some(gpu) = software() else { return };
    // The methods hardly differ, so the second drawing has a wider motorway and a wider side road.
    let first = near(&gpu, &near_style(), RoadMethod::Geometry);
    let mut wider = near_style();
    wider.roads[0].width_m *= 1.3;
    wider.roads[6].width_m *= 1.3;
    let second = near(&gpu, &wider, RoadMethod::ShadowVolumes);
    let difference = Picture::new(&gpu, SIZE, 1).unwrap();
    Renderer::new(&gpu).draw_difference(&gpu, &first, &second, &difference).unwrap();
    golden().check("difference", &image(&gpu, &difference));
}

/// The comparison finds a difference where there is one.
#[test]
fn a_road_five_percent_wider_is_no_match() {
    if is_blessing() {
        return;
    }
    let Some(gpu) = software() else { return };
    let mut style = near_style();
    style.roads[4].width_m *= 1.05;
    let picture = image(&gpu, &near(&gpu, &style, RoadMethod::ShadowVolumes).picture);
    let found = golden().mismatch("junction-sv", &picture).unwrap();
    println!("must fail, one road 5 % wider: {found}");
    assert!(!found.is_match());
}

#[test]
fn a_colour_three_percent_off_is_no_match() {
    if is_blessing() {
        return;
    }
    let Some(gpu) = software() else { return };
    let mut style = near_style();
    let [red, green, blue] = style.roads[4].bands.main_color();
    style.roads[4].bands = RoadBands::one([red, green, blue + 0.03]);
    let picture = image(&gpu, &near(&gpu, &style, RoadMethod::ShadowVolumes).picture);
    let found = golden().mismatch("junction-sv", &picture).unwrap();
    println!("must fail, one colour 3 % off: {found}");
    assert!(!found.is_match());
}

#[test]
fn a_picture_of_another_size_is_no_match() {
    assert!(golden().mismatch("junction-sv", &RgbaImage::new(SIZE[0], SIZE[1] - 1)).is_err());
}
