//! Finds the blocks of samples with labels in or near them. Only these blocks are drawn when labels
//! become colours: most of a picture has no labels.

use wgpu::{BindGroupLayout, ColorWrites, CommandEncoder, Device, RenderPipeline};

use super::super::{
    bindings::{UNFILTERED, layout, texture, textures},
    formats::LABEL,
    passes::full_screen,
    pipeline::{PipelineRecipe, Shader, shader},
    shared_bindings::{DrawnFrame, SharedLayouts},
    targets::{BLOCK_SIDE, LabelTargets},
};

pub(crate) const SHADER: Shader = shader!("blocks": "common", "screen", "blocks");

/// Corners of the two triangles of a block, in the order of `shaders/labelled.wgsl`.
pub(crate) const BLOCK_CORNERS: u32 = 6;

/// Constants for shaders that use blocks.
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
            ..PipelineRecipe::new(SHADER, &groups, &BLOCK)
        };
        let pipeline = recipe.build(device);
        Self { layout, pipeline }
    }

    /// Finds the blocks of some labels. It uses a pass of its own, because nothing else draws into
    /// their texture.
    pub(crate) fn find(
        &self,
        DrawnFrame { gpu, shared, .. }: DrawnFrame<'_>,
        encoder: &mut CommandEncoder,
        targets: &LabelTargets,
    ) {
        let bound = textures(gpu, &self.layout, &[&targets.labels.view]);
        let groups = [&shared.frame, &bound];
        full_screen(encoder, "blocks", &targets.blocks.view, &self.pipeline, &groups);
    }
}
