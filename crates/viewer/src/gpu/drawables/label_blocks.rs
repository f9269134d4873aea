//! Finds the blocks of samples with labels in them or near them. What turns labels into colours draws these blocks alone: most of a
//! picture has none.

use wgpu::{BindGroupLayout, ColorWrites, CommandEncoder, Device, RenderPipeline};

use super::super::{
    Gpu,
    bindings::{UNFILTERED, layout, texture, textures},
    formats::LABEL,
    passes::full_screen,
    pipeline::{PipelineRecipe, Shader, shader},
    shared_bindings::{SharedBindings, SharedLayouts},
    targets::{BLOCK_SIDE, LabelTargets},
};

pub(crate) const SHADER: Shader = shader!("blocks": "common", "screen", "blocks");

/// Corners of the two triangles of a block, as `shaders/labelled.wgsl` counts them.
pub(crate) const BLOCK_CORNERS: u32 = 6;

/// What shaders are told of blocks.
pub(crate) const BLOCK: [(&str, f64); 1] = [("BLOCK", BLOCK_SIDE as f64)];

pub(crate) struct LabelBlocks {
    layout: BindGroupLayout,
    pipeline: RenderPipeline,
}

impl LabelBlocks {
    pub(crate) fn new(device: &Device, layouts: &SharedLayouts) -> Self {
        let layout = layout(device, "blocks", &[texture(0, UNFILTERED)]);
        let groups = [Some(&layouts.frame), Some(&layout)];
        let recipe = PipelineRecipe {
            targets: &[(LABEL, ColorWrites::ALL)],
            ..PipelineRecipe::full_screen(SHADER, &groups, &BLOCK)
        };
        let pipeline = recipe.build(device);
        Self { layout, pipeline }
    }

    /// Finds the blocks of some labels. It begins and ends a pass of its own, because nothing else draws into their texture.
    pub(crate) fn find(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        shared: &SharedBindings,
        targets: &LabelTargets,
    ) {
        let bound = textures(gpu, &self.layout, &[&targets.labels.view]);
        let groups = [&shared.frame, &bound];
        full_screen(encoder, "blocks", &targets.blocks.view, &self.pipeline, &groups);
    }
}
