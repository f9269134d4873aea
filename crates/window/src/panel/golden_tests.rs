//! Compares the window as painted now with images that were inspected and accepted: the positions
//! of panel, attribution, scale, compass and notices, and that each can be read.
//!
//! The images apply to software Vulkan (llvmpipe) only. `CORNICHE_BLESS=1 cargo test -p
//! corniche-window golden` accepts the images painted now. Inspect them.

use corniche_testing::pictures::{Golden, is_blessing};
use corniche_viewer::gpu::Gpu;
use egui_wgpu::ScreenDescriptor;
use image::RgbaImage;

use super::*;
use crate::canvas::{
    Canvas,
    tests::{canvas, scene_of_size},
};

fn golden() -> Golden {
    Golden::of_crate(env!("CARGO_MANIFEST_DIR"), option_env!("CARGO_TARGET_TMPDIR"))
}

fn is_pinned(gpu: &Gpu) -> bool {
    let is_pinned = ["llvmpipe", "vulkan"].iter().all(|part| gpu.adapter_name.contains(part));
    if !is_pinned {
        corniche_testing::skip(&format!(
            "these pictures are llvmpipe's, not {}'s",
            gpu.adapter_name
        ));
    }
    is_pinned
}

/// Paints the window over a map of sky and void.
fn painted(canvas: &mut Canvas, size_px: [u32; 2], settings: &mut MapSettings) -> RgbaImage {
    canvas.draw(&scene_of_size(settings.compare, size_px)).unwrap();
    let pictures = canvas.pictures();
    let told = Told::new();
    let ctx = egui::Context::default();
    set_up(&ctx);
    let size = size_px.map(|side| side as f32);
    let mut output = egui::FullOutput::default();
    // The toolkit knows the sizes of its items from the second pass on.
    for _ in 0..2 {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(egui::Pos2::ZERO, size.into())),
            ..RawInput::default()
        };
        output = ctx.run_ui(input, |ui| {
            show(ui, settings, &told.content(), &pictures);
        });
        canvas.take_textures(std::mem::take(&mut output.textures_delta));
    }
    let primitives = ctx.tessellate(output.shapes, 1.0);
    let screen = ScreenDescriptor { size_in_pixels: size_px, pixels_per_point: 1.0 };
    let snapshot = canvas.snap_window(&primitives, &screen);
    snapshot.into_image(canvas.gpu()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_window_looks_as_it_did() {
    let Some(mut canvas) = canvas() else { return };
    if !is_pinned(canvas.gpu()) {
        return;
    }
    let split = MapSettings { compare: Compare::Split, ..usual() };
    for (name, size_px, mut settings) in
        [("window", [820, 640], usual()), ("window-small-split", [400, 300], split)]
    {
        golden().check(name, &painted(&mut canvas, size_px, &mut settings));
    }
}

/// The comparison detects a real difference.
#[test]
fn a_window_without_its_panel_is_no_match() {
    if is_blessing() {
        return;
    }
    let Some(mut canvas) = canvas() else { return };
    if !is_pinned(canvas.gpu()) {
        return;
    }
    let mut hidden = MapSettings { is_panel_open: false, ..usual() };
    let found =
        golden().mismatch("window", &painted(&mut canvas, [820, 640], &mut hidden)).unwrap();
    println!("must fail, the panel hidden: {found}");
    assert!(!found.is_match());
}
