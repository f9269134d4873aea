//! Ground, sky and roads into the samples of a picture.

use corniche_styles::{RoadBands, RoadStyle};
use glam::DVec4;
use wgpu::{
    BindGroupLayout, BindGroupLayoutEntry, BindingResource, Buffer, BufferUsages, Device,
    RenderPass, RenderPipeline, ShaderStages,
};

use super::super::{
    Gpu,
    bindings::{UNFILTERED, group, layout, texture, uniform},
    pipeline::{PipelineRecipe, Shader, shader},
    shared_bindings::{SharedBindings, SharedLayouts},
    targets::{LabelTargets, Targets},
    uniforms::{color, row},
};
use super::label_blocks::{BLOCK_CORNERS, block_constant};
use crate::{frame_view::FrameView, options::RoadMethod};

pub(crate) const SHADER: Shader =
    shader!("composite": "common", "screen", "labelled", "road_colors", "composite");

/// Draws ground and sky everywhere, then the blocks with roads again, with their roads.
///
/// These are two draws, because one that looks up the block of each pixel took about twice as long on software Vulkan,
/// which runs both branches of a condition.
pub(crate) struct Composite {
    layout: BindGroupLayout,
    /// Draws ground and sky, everywhere.
    ground: RenderPipeline,
    /// Draws ground, sky and roads, block by block.
    roads: RenderPipeline,
}

impl Composite {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let block = block_constant();
        let road_blocks =
            BindGroupLayoutEntry { visibility: ShaderStages::VERTEX, ..texture(2, UNFILTERED) };
        let [depth, labels, ground] = [0, 1, 4].map(|binding| texture(binding, UNFILTERED));
        let layout =
            layout(device, "composite", &[depth, labels, road_blocks, uniform(3, None), ground]);
        let groups = [Some(&layouts.frame), Some(&layout)];
        let composite = |entries| {
            let recipe = PipelineRecipe::full_screen(SHADER, &groups, &block);
            PipelineRecipe { entries, ..recipe }.build(device)
        };
        let ground = composite(["vertex", "ground_fragment"]);
        let roads = composite(["block_vertex", "road_fragment"]);
        Self { layout, ground, roads }
    }

    /// Draws the samples of the picture of `targets`, after ground and roads were drawn and the blocks found. The pass draws
    /// into that picture.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        view: &FrameView<'_>,
        targets: &Targets,
    ) {
        let colors = colors_of(gpu, view);
        let Targets { ground, depth, roads: LabelTargets { labels, blocks }, .. } = targets;
        let [ground, depth, labels, blocks] = [ground, depth, labels, blocks]
            .map(|texture| BindingResource::TextureView(&texture.view));
        let resources = [depth, labels, blocks, colors.as_entire_binding(), ground];
        shared.set_frame(pass);
        pass.set_bind_group(1, &group(gpu, &self.layout, &resources), &[]);
        pass.set_pipeline(&self.ground);
        pass.draw(0..3, 0..1);
        if view.roads.method != RoadMethod::None {
            pass.set_pipeline(&self.roads);
            pass.draw(0..BLOCK_CORNERS * targets.block_count(), 0..1);
        }
    }
}

/// The colours of a picture on the graphics card.
pub(crate) fn colors_of(gpu: &Gpu, view: &FrameView<'_>) -> Buffer {
    gpu.buffer("picture colors", bytemuck::cast_slice(&rows(view)), BufferUsages::UNIFORM)
}

/// The plane that is seen where there is no ground, beneath all ground and its walls: the eye's place on it in plan, modulo
/// the last value; the eye's height above it; the widest spacing of lines on it. World metres.
fn void_plane(view: &FrameView<'_>) -> DVec4 {
    let eye = view.camera.eye_in_world();
    let lowest = (view.height_range_m[0] - view.wall_m) * view.vertical_scale();
    // Spacings are powers of two, so that all of them divide this one. In f32, a place then has 2^-24 of it.
    let widest = libm::exp2(libm::log2(4096.0 * view.camera.focus_m()).round());
    DVec4::new(eye.x.rem_euclid(widest), eye.y.rem_euclid(widest), eye.z - lowest, widest)
}

/// The block `struct PictureColors` of `shaders/road_colors.wgsl`.
pub(crate) fn rows(view: &FrameView<'_>) -> Vec<[f32; 4]> {
    let style = view.style;
    let mut rows = vec![
        color(style.haze, (f64::from(style.haze_reach) * view.camera.focus_m()) as f32),
        color(style.sky, 0.0),
        color(style.void, 0.0),
        row(void_plane(view)),
    ];
    let roads = &style.roads;
    for road in roads {
        let mut bands = [[0.0; 4]; RoadBands::MOST];
        for (row, band) in bands.iter_mut().zip(road.bands.all()) {
            *row = color(band.color, 1.0);
        }
        rows.extend(bands);
    }
    rows.extend(roads.iter().map(|road| color(road.outline, 1.0)));
    rows.extend(roads.iter().map(|road| color(road.bands.main_color(), 1.0)));
    let thin = |road: &RoadStyle| road.thin.unwrap_or(road.bands.main_color());
    rows.extend(roads.iter().map(|road| color(thin(road), 1.0)));
    rows.push(color(style.wall, 1.0));
    rows
}
