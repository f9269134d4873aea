//! Turns labels into colours, block by block, where there are some.

use wgpu::{
    BindGroupLayout, BindGroupLayoutEntry, BindingResource, BlendState, BufferUsages, Device,
    RenderPass, RenderPipeline, ShaderStages,
};

use super::{
    super::{
        Gpu,
        bindings::{UNFILTERED, group, layout, texture, uniform},
        pipeline::{PipelineRecipe, Shader},
        shared_bindings::{SharedBindings, SharedLayouts},
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
    /// `more` is how many textures the shader reads beside what `shaders/labelled.wgsl` and the colours are.
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
            ..PipelineRecipe::full_screen(shader, &groups, &BLOCK)
        };
        let pipeline = recipe.build(device);
        Self { layout, pipeline }
    }

    /// Binds the colours `rows`, the depth of the ground, and labels, after their blocks were found.
    pub(crate) fn bind(
        &self,
        gpu: &Gpu,
        pass: &mut RenderPass<'_>,
        shared: &SharedBindings,
        rows: &[[f32; 4]],
        (targets, LabelTargets { labels, blocks }): (&Targets, &LabelTargets),
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

    /// Draws with what is bound.
    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>, targets: &Targets) {
        pass.set_pipeline(&self.pipeline);
        pass.draw(0..BLOCK_CORNERS * targets.block_count(), 0..1);
    }
}
