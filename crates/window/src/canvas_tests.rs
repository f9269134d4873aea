//! The canvas shows the map pixel by pixel and draws only what has changed.

use std::time::{Duration, Instant};

use corniche_live::{Compare, PixelReading};
use corniche_styles::Style;
use corniche_viewer::{
    RoadMethod, RoadOptions,
    camera::{Camera, Orientation},
    gpu::Picture,
};
use egui::{Color32, Rect, pos2};
use glam::DVec3;
use image::RgbaImage;

use super::*;

const SIZE_PX: [u32; 2] = [64, 48];

/// Returns a canvas; prints a message and returns `None` if there is no graphics device.
pub(crate) fn canvas() -> Option<Canvas> {
    match Gpu::new() {
        Ok(gpu) => Some(Canvas::new(gpu, wgpu::TextureFormat::Bgra8Unorm)),
        Err(error) => {
            assert!(std::env::var_os("CORNICHE_REQUIRE_GPU").is_none(), "{error}");
            corniche_testing::skip(&error.to_string());
            None
        }
    }
}

/// A scene of sky and void, so that no tile is needed.
fn scene(compare: Compare) -> MapScene {
    scene_of_size(compare, SIZE_PX)
}

/// The same scene with heights doubled.
fn raised() -> MapScene {
    MapScene { exaggeration: 2.0, ..scene(Compare::Off) }
}

pub(crate) fn scene_of_size(compare: Compare, size_px: [u32; 2]) -> MapScene {
    let level = Orientation { heading_deg: 0.0, pitch_deg: 80.0 };
    MapScene {
        camera: Camera::look_at(DVec3::ZERO, 1000.0, level, size_px),
        shown_px: size_px,
        style: Style::road_atlas(),
        layers: corniche_viewer::PackageLooks::default(),
        compare,
        roads: compare.pictures(RoadOptions::for_method(RoadMethod::Geometry)),
        exaggeration: 1.0,
        point_scale: 1.0,
        height_range_m: [0.0, 100.0],
        cell_px: f64::INFINITY,
        latitude_deg: 47.0,
        is_wireframe: false,
        drawn: Vec::new(),
        samples_per_side: 1,
        revision: 0,
    }
}

fn red_beside_map(ui: &mut egui::Ui, texture: TextureId) {
    let whole = ui.ctx().viewport_rect();
    let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    ui.painter().image(texture, whole, uv, Color32::WHITE);
    ui.painter().rect_filled(whole.with_max_x(32.0), 0, Color32::from_rgb(200, 30, 10));
}

/// The window with a red left half over the map.
fn paint(canvas: &mut Canvas) -> RgbaImage {
    let [texture] = canvas.pictures()[..] else { panic!("more than one") };
    let ui = egui::Context::default();
    let [width, height] = SIZE_PX.map(|side| side as f32);
    let input = egui::RawInput {
        screen_rect: Some(Rect::from_min_max(pos2(0.0, 0.0), pos2(width, height))),
        ..egui::RawInput::default()
    };
    let mut output = ui.run_ui(input, |ui| red_beside_map(ui, texture));
    canvas.take_textures(std::mem::take(&mut output.textures_delta));
    let primitives = ui.tessellate(output.shapes, 1.0);
    let screen = ScreenDescriptor { size_in_pixels: SIZE_PX, pixels_per_point: 1.0 };
    let snapshot = canvas.snap_window(&primitives, &screen);
    snapshot.into_image(canvas.gpu()).unwrap_or_else(|error| panic!("{error}"))
}

fn map(canvas: &Canvas) -> RgbaImage {
    canvas.snap_map(0.5).expect("something is shown").into_image(canvas.gpu()).unwrap()
}

#[test]
fn the_map_is_shown_pixel_for_pixel_beneath_the_panel() {
    let Some(mut canvas) = canvas() else { return };
    canvas.draw(&scene(Compare::Off)).unwrap();
    let (map, window) = (map(&canvas), paint(&mut canvas));
    assert_eq!(window.dimensions(), (64, 48));
    // Some pixels at the edge belong to the toolkit, which smooths it.
    for (x, y, pixel) in window.enumerate_pixels().filter(|(x, ..)| !(30..=34).contains(x)) {
        let expected = if x < 32 { [200, 30, 10, 255] } else { map.get_pixel(x, y).0 };
        assert_eq!(pixel.0, expected, "{x}, {y}");
    }
    assert_ne!(map.get_pixel(40, 2), map.get_pixel(40, 46), "sky above, void below");
}

#[test]
fn only_another_scene_is_drawn() {
    let Some(mut canvas) = canvas() else { return };
    assert!(canvas.draw(&scene(Compare::Off)).unwrap());
    let first = canvas.pictures();
    assert!(!canvas.draw(&scene(Compare::Off)).unwrap());
    assert!(canvas.draw(&raised()).unwrap());
    assert_eq!(first, canvas.pictures(), "in the same texture");
    canvas.draw(&scene(Compare::Split)).unwrap();
    assert!(matches!(canvas.pictures()[..], [left, right] if left != right));
    canvas.draw(&scene(Compare::Difference)).unwrap();
    assert!(matches!(canvas.pictures()[..], [texture] if texture != first[0]));
}

#[test]
fn a_picture_shows_what_was_shown_when_it_was_asked_for() {
    let Some(mut canvas) = canvas() else { return };
    canvas.draw(&scene(Compare::Off)).unwrap();
    let before = map(&canvas);
    let mut snapshot = canvas.snap_map(0.5).unwrap();
    let night = Style { sky: [0.0; 3], ..Style::road_atlas() };
    let other = MapScene { style: night, ..scene(Compare::Off) };
    canvas.draw(&other).unwrap();
    assert_ne!(map(&canvas), before, "something else is shown by now");
    let begun = Instant::now();
    while !snapshot.pixels.has_arrived(canvas.gpu()).unwrap() {
        assert!(begun.elapsed() < Duration::from_mins(1));
    }
    assert_eq!(snapshot.into_image(canvas.gpu()).unwrap(), before);
}

/// An image of one colour.
fn plain(gpu: &Gpu, color: wgpu::Color) -> Picture {
    let picture = Picture::new(gpu, SIZE_PX, 1).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(color), store: wgpu::StoreOp::Store };
    drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: picture.view(),
            depth_slice: None,
            resolve_target: None,
            ops,
        })],
        ..Default::default()
    }));
    gpu.queue.submit([encoder.finish()]);
    picture
}

#[test]
fn a_split_picture_has_both_sides() {
    let Some(canvas) = canvas() else { return };
    let gpu = canvas.gpu();
    let [red, blue] = [wgpu::Color::RED, wgpu::Color::BLUE].map(|color| plain(gpu, color));
    let [red, blue] = [red, blue].map(|picture| picture.begin_read(gpu));
    let parts = vec![(red, 0..16), (blue, 16..SIZE_PX[0])];
    let both = PixelReading { parts, size_px: SIZE_PX };
    let both = Snapshot { pixels: both, has_blue_first: false }.into_image(gpu).unwrap();
    for (x, y, pixel) in both.enumerate_pixels() {
        let expected = if x < 16 { [255, 0, 0, 255] } else { [0, 0, 255, 255] };
        assert_eq!(pixel.0, expected, "{x}, {y}");
    }
}

#[test]
fn in_a_hurry_fewer_pixels_are_drawn() {
    let Some(mut canvas) = canvas() else { return };
    let full = scene(Compare::Off);
    canvas.draw(&full).unwrap();
    assert!(canvas.is_full());
    let level = Orientation { heading_deg: 0.0, pitch_deg: 80.0 };
    let camera = Camera::look_at(DVec3::ZERO, 1000.0, level, [32, 24]);
    let coarse = MapScene { camera, ..full.clone() };
    canvas.draw(&coarse).unwrap();
    assert!(!canvas.is_full());
    assert_eq!(map(&canvas).dimensions(), (32, 24));
    assert!(canvas.draw(&full).unwrap() && canvas.is_full());
}

#[test]
fn what_was_lost_is_drawn_again_by_another_canvas() {
    let Some(mut first) = canvas() else { return };
    first.draw(&scene(Compare::Off)).unwrap();
    let before = map(&first);
    first.gpu().device.destroy();
    // Further drawing may or may not report the loss, but it must not end the program.
    let _ = first.draw(&raised());
    let _ = first.map.times();
    assert!(first.gpu().is_lost());
    let Some(mut second) = canvas() else { return };
    assert!(!second.gpu().is_lost());
    second.draw(&scene(Compare::Off)).unwrap();
    assert_eq!(map(&second), before);
}
