//! Lines beside the roads: the labels of one layer into colours over the picture.

use corniche_styles::RoadBands;
use wgpu::{
    BindGroupLayout, BindGroupLayoutEntry, BindingResource, BlendState, BufferUsages, Device,
    RenderPass, RenderPipeline, ShaderStages,
};

use super::{
    super::{
        Gpu,
        bindings::{UNFILTERED, group, layout, texture, uniform},
        pipeline::{PipelineRecipe, Shader, shader},
        shared_bindings::{SharedBindings, SharedLayouts},
        targets::{LabelTargets, Targets},
        uniforms::color,
    },
    label_blocks::{BLOCK_CORNERS, block_constant},
};
use crate::{frame_view::FrameView, tiles::LineLayer};

pub(crate) const SHADER: Shader = shader!("lines": "common", "screen", "labelled", "lines");

/// Draws lines over the picture.
pub(crate) struct LineColors {
    layout: BindGroupLayout,
    pipeline: RenderPipeline,
}

impl LineColors {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let blocks =
            BindGroupLayoutEntry { visibility: ShaderStages::VERTEX, ..texture(2, UNFILTERED) };
        let [depth, labels] = [0, 1].map(|binding| texture(binding, UNFILTERED));
        let roads = texture(4, UNFILTERED);
        let layout = layout(device, "lines", &[depth, labels, blocks, uniform(3, None), roads]);
        let groups = [Some(&layouts.frame), Some(&layout)];
        let constants = block_constant();
        let recipe = PipelineRecipe {
            entries: ["block_vertex", "line_fragment"],
            blend: Some(BlendState::ALPHA_BLENDING),
            ..PipelineRecipe::full_screen(SHADER, &groups, &constants)
        };
        let pipeline = recipe.build(device);
        Self { layout, pipeline }
    }

    /// Draws a layer over the samples of the picture, after the labels of roads. `shared` and `view` are those of the layer: its styles have
    /// the places of roads.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        (view, layer): (&FrameView<'_>, LineLayer),
        targets: &Targets,
    ) {
        let rows = rows(view, layer);
        let colors = gpu.buffer("line colors", bytemuck::cast_slice(&rows), BufferUsages::UNIFORM);
        let LabelTargets { labels, blocks } = targets.lines(gpu);
        let [depth, labels, blocks, roads] =
            [&targets.depth, labels, blocks, &targets.roads.labels]
                .map(|texture| BindingResource::TextureView(&texture.view));
        let resources = [depth, labels, blocks, colors.as_entire_binding(), roads];
        shared.set_frame(pass);
        pass.set_bind_group(1, &group(gpu, &self.layout, &resources), &[]);
        pass.set_pipeline(&self.pipeline);
        pass.draw(0..BLOCK_CORNERS * targets.block_count(), 0..1);
    }
}

/// The block `struct LineColors` of `shaders/lines.wgsl`.
pub(crate) fn rows(view: &FrameView<'_>, layer: LineLayer) -> Vec<[f32; 4]> {
    let style = view.style;
    let reach_m = f64::from(style.haze_reach) * view.camera.focus_m();
    let makes_room = if layer == LineLayer::Boundaries { 1.0 } else { 0.0 };
    let mut rows = vec![color(style.haze, reach_m as f32), [makes_room, 0.0, 0.0, 0.0]];
    for road in &style.roads {
        let mut bands = [[0.0; 4]; RoadBands::MOST];
        for (row, band) in bands.iter_mut().zip(road.bands.all()) {
            *row = color(band.color, 1.0);
        }
        rows.extend(bands);
    }
    rows
}
