//! Averages the samples of a picture to its pixels.

use std::sync::OnceLock;

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
    /// The pipelines for 2, 3 and 4 samples on each side of a pixel, created at first use.
    pipelines: [OnceLock<RenderPipeline>; MAX_SAMPLES_PER_SIDE as usize - 1],
}

impl Average {
    pub(crate) fn new(device: &Device) -> Self {
        let layout = layout(device, "average", &[texture(0, UNFILTERED)]);
        Self { layout, pipelines: Default::default() }
    }

    /// Draws the pixels of a picture. With one sample per pixel they are drawn already.
    pub(crate) fn draw(&self, gpu: &Gpu, encoder: &mut CommandEncoder, picture: &Picture) {
        let Some(samples) = picture.samples() else { return };
        let bound = textures(gpu, &self.layout, &[samples]);
        let per_side = picture.samples_per_side;
        let pipeline = self.pipelines[per_side as usize - 2].get_or_init(|| {
            let constants = [("PER_SIDE", f64::from(per_side))];
            let groups = [Some(&self.layout)];
            PipelineRecipe::new(SHADER, &groups, &constants).build(&gpu.device)
        });
        full_screen(encoder, "average", picture.view(), pipeline, &[&bound]);
    }
}
