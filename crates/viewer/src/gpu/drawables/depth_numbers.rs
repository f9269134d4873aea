//! Depths as numbers in an ordinary texture: a depth texture can only be copied as a whole, and the
//! largest ones exceed the maximum size of a buffer.

use wgpu::ColorWrites;

use super::super::{
    Gpu,
    bindings::{UNFILTERED, layout, texture, textures},
    formats::NUMBER,
    passes::full_screen,
    pipeline::{PipelineRecipe, Shader, shader},
    target_texture::TargetTexture,
};

pub(crate) const SHADER: Shader = shader!("depth numbers": "screen", "depth_numbers");

/// Returns the values of a depth texture, in a texture that can be copied in parts.
pub(crate) fn depth_numbers(gpu: &Gpu, depth: &TargetTexture) -> TargetTexture {
    let size_px = [depth.texture.width(), depth.texture.height()];
    let numbers = TargetTexture::new(gpu, "depth numbers", NUMBER, size_px);
    let layout = layout(&gpu.device, "depth numbers", &[texture(0, UNFILTERED)]);
    let bound = textures(gpu, &layout, &[&depth.view]);
    let pipeline = PipelineRecipe {
        targets: &[(NUMBER, ColorWrites::ALL)],
        ..PipelineRecipe::new(SHADER, &[Some(&layout)], &[])
    }
    .build(&gpu.device);
    gpu.submit("depth numbers", |encoder| {
        full_screen(encoder, "depth numbers", &numbers.view, &pipeline, &[&bound]);
    });
    numbers
}
