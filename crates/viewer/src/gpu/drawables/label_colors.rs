//! Turns labels into colours, for the blocks that have labels.

use wgpu::{
    BindGroupLayout, BindGroupLayoutEntry, BindingResource, BlendState, BufferUsages, Device,
    RenderPass, RenderPipeline, ShaderStages,
};

use super::{
    super::{
        bindings::{UNFILTERED, group, layout, texture, uniform},
        pipeline::{PipelineRecipe, Shader},
        shared_bindings::{DrawnFrame, SharedLayouts},
        target_texture::TargetTexture,
        targets::{LabelTargets, Targets},
    },
    label_blocks::{BLOCK, BLOCK_CORNERS},
};

/// Draws the blocks with labels over the samples of a picture.
pub(crate) struct LabelColors {
    pub(crate) layout: BindGroupLayout,
    pipeline: RenderPipeline,
}

impl LabelColors {
    /// Creates the pipeline. `more` is the number of additional textures that the shader reads,
    /// besides the textures of `shaders/labelled.wgsl` and the colours.
    pub(crate) fn new(
        device: &Device,
        layouts: &SharedLayouts,
        (shader, fragment): (Shader, &str),
        blend: Option<BlendState>,
        more: u32,
    ) -> Self {
        let blocks =
            BindGroupLayoutEntry { visibility: ShaderStages::VERTEX, ..texture(2, UNFILTERED) };
        let [depth, labels] = [0, 1].map(|binding| texture(binding, UNFILTERED));
        let mut entries = vec![depth, labels, blocks, uniform(3, None)];
        entries.extend((4..4 + more).map(|binding| texture(binding, UNFILTERED)));
        let layout = layout(device, shader.0, &entries);
        let groups = [Some(&layouts.frame), Some(&layout)];
        let recipe = PipelineRecipe {
            entries: ["block_vertex", fragment],
            blend,
            ..PipelineRecipe::new(shader, &groups, &BLOCK)
        };
        let pipeline = recipe.build(device);
        Self { layout, pipeline }
    }

    /// Binds the colours `rows`, the depth of the ground, and labels. Their blocks must have been
    /// found.
    pub(crate) fn bind(
        &self,
        DrawnFrame { gpu, shared, targets, .. }: DrawnFrame<'_>,
        pass: &mut RenderPass<'_>,
        rows: &[[f32; 4]],
        LabelTargets { labels, blocks }: &LabelTargets,
        more: &[&TargetTexture],
    ) {
        let colors = gpu.buffer("colors", bytemuck::cast_slice(rows), BufferUsages::UNIFORM);
        let mut resources: Vec<_> = [&targets.depth, labels, blocks]
            .iter()
            .chain(more)
            .map(|texture| BindingResource::TextureView(&texture.view))
            .collect();
        resources.insert(3, colors.as_entire_binding());
        shared.set_frame(pass);
        pass.set_bind_group(1, &group(gpu, &self.layout, &resources), &[]);
    }

    /// Draws with the bound resources.
    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>, targets: &Targets) {
        pass.set_pipeline(&self.pipeline);
        pass.draw(0..BLOCK_CORNERS * targets.block_count(), 0..1);
    }
}
