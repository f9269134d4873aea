//! The samples of a picture, averaged to its pixels.

use wgpu::{BindGroupLayout, CommandEncoder, Device, RenderPipeline};

use super::super::{
    Gpu,
    bindings::{UNFILTERED, layout, texture, textures},
    passes::full_screen,
    picture::{MAX_SAMPLES_PER_SIDE, Picture},
    pipeline::{PipelineRecipe, Shader, shader},
};

pub(crate) const SHADER: Shader = shader!("average": "screen", "average");

/// Averages the samples of each pixel.
pub(crate) struct Average {
    layout: BindGroupLayout,
    /// For 2, 3 and 4 samples on each side of a pixel.
    pipelines: [RenderPipeline; MAX_SAMPLES_PER_SIDE as usize - 1],
}

impl Average {
    pub(crate) fn new(device: &Device) -> Self {
        let layout = layout(device, "average", &[texture(0, UNFILTERED)]);
        let pipelines = [2.0, 3.0, 4.0].map(|per_side| {
            let constants = [("PER_SIDE", per_side)];
            PipelineRecipe::full_screen(SHADER, &[Some(&layout)], &constants).build(device)
        });
        Self { layout, pipelines }
    }

    /// Draws the pixels of a picture. With one sample a pixel they are drawn already.
    pub(crate) fn draw(&self, gpu: &Gpu, encoder: &mut CommandEncoder, picture: &Picture) {
        let Some(samples) = picture.samples() else { return };
        let bound = textures(gpu, &self.layout, &[samples]);
        let pipeline = &self.pipelines[picture.samples_per_side() as usize - 2];
        full_screen(encoder, "average", picture.view(), pipeline, &[&bound]);
    }
}
