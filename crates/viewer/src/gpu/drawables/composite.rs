//! Draws ground, sky and roads into the samples of a picture.

use corniche_styles::{RoadBands, RoadStyle, Style};
use glam::DVec4;
use wgpu::{Device, RenderPass, RenderPipeline};

use super::{
    super::{
        pipeline::{PipelineRecipe, Shader, shader},
        shared_bindings::{DrawnFrame, SharedLayouts},
        uniforms::{color, row},
    },
    label_blocks::BLOCK,
    label_colors::LabelColors,
};
use crate::{frame_view::FrameView, options::RoadMethod};

pub(crate) const SHADER: Shader =
    shader!("composite": "common", "screen", "labelled", "road_colors", "composite");

/// Draws ground and sky everywhere, then draws the blocks with roads again, with their roads.
///
/// These are two draw calls, because one call that looks up the block of each pixel took about
/// twice as long on software Vulkan, which runs both branches of a condition.
pub(crate) struct Composite {
    /// Draws ground and sky, everywhere.
    ground: RenderPipeline,
    /// Draws ground, sky and roads, block by block.
    roads: LabelColors,
}

impl Composite {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let roads = LabelColors::new(device, layouts, (SHADER, "road_fragment"), None, 1);
        let groups = [Some(&layouts.frame), Some(&roads.layout)];
        let ground = PipelineRecipe {
            entries: ["vertex", "ground_fragment"],
            ..PipelineRecipe::new(SHADER, &groups, &BLOCK)
        };
        Self { ground: ground.build(device), roads }
    }

    /// Draws the samples of the picture of `targets`, after ground and roads were drawn and the
    /// blocks were found. The pass must draw into that picture.
    pub(crate) fn draw(&self, frame: DrawnFrame<'_>, pass: &mut RenderPass<'_>) {
        let DrawnFrame { view, targets, .. } = frame;
        self.roads.bind(frame, pass, &rows(view), &targets.roads, &[&targets.ground]);
        pass.set_pipeline(&self.ground);
        pass.draw(0..3, 0..1);
        if view.roads.method != RoadMethod::None {
            self.roads.draw(pass, targets);
        }
    }
}

/// The plane that is visible where there is no ground, below all ground and its walls: the eye's
/// position on it in plan, modulo the last value; the eye's height above it; the widest spacing of
/// lines on it. World metres.
fn void_plane(view: &FrameView<'_>) -> DVec4 {
    let eye = view.camera.eye_in_world;
    let lowest = (view.height_range_m[0] - view.wall_m) * view.vertical_scale();
    // Spacings are powers of two, so that all of them divide this one. In f32, a position is
    // precise to 2^-24 of it.
    let widest = libm::exp2(libm::log2(4096.0 * view.camera.focus_m).round());
    DVec4::new(eye.x.rem_euclid(widest), eye.y.rem_euclid(widest), eye.z - lowest, widest)
}

/// The block `struct PictureColors` of `shaders/road_colors.wgsl`.
pub(crate) fn rows(view: &FrameView<'_>) -> Vec<[f32; 4]> {
    let style = view.style;
    let mut rows =
        vec![haze(view), color(style.sky, 0.0), color(style.void, 0.0), row(void_plane(view))];
    let roads = &style.roads;
    rows.extend(bands(style));
    rows.extend(roads.iter().map(|road| color(road.outline, 1.0)));
    rows.extend(roads.iter().map(|road| color(road.bands.main_color(), 1.0)));
    let thin = |road: &RoadStyle| road.thin.unwrap_or(road.bands.main_color());
    rows.extend(roads.iter().map(|road| color(thin(road), 1.0)));
    rows.push(color(style.wall, 0.0));
    rows
}

/// Colour of the haze, and the distance at which it hides two thirds of other colours.
pub(crate) fn haze(view: &FrameView<'_>) -> [f32; 4] {
    let Style { haze, haze_reach, .. } = view.style;
    color(*haze, (f64::from(*haze_reach) * view.camera.focus_m) as f32)
}

/// The colours of the bands of each class, padded to the maximum number of bands.
pub(crate) fn bands(style: &Style) -> impl Iterator<Item = [f32; 4]> {
    style.roads.iter().flat_map(|road| {
        let mut bands = [[0.0; 4]; RoadBands::MOST];
        for (row, band) in bands.iter_mut().zip(road.bands.all()) {
            *row = color(band.color, 1.0);
        }
        bands
    })
}
