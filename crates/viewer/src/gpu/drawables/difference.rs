//! Where the roads of two drawings differ.

use wgpu::{BindGroupLayout, CommandEncoder, Device, RenderPipeline};

use super::super::{
    Gpu,
    bindings::{UNFILTERED, layout, texture, textures},
    passes::full_screen,
    picture::Picture,
    pipeline::{PipelineRecipe, Shader, shader},
    targets::Targets,
};
use corniche_styles::Rgb;

pub(crate) const SHADER: Shader = shader!("difference": "screen", "difference");

/// The colours that [`Renderer::draw_difference`](super::super::Renderer::draw_difference) paints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DifferenceColors {
    /// Road in the first only.
    pub first_only: Rgb,
    /// Road in the second only.
    pub second_only: Rgb,
    /// Road in both, but of another class, or a centre line in one of them.
    pub other_label: Rgb,
}

/// Vermilion, blue and reddish purple, which people with any kind of colour vision can tell apart.
///
/// Source: Okabe & Ito 2008, *Color Universal Design*. `shaders/difference.wgsl` has the same numbers.
pub const DIFFERENCE_COLORS: DifferenceColors = DifferenceColors {
    first_only: [213.0 / 255.0, 94.0 / 255.0, 0.0],
    second_only: [0.0, 114.0 / 255.0, 178.0 / 255.0],
    other_label: [204.0 / 255.0, 121.0 / 255.0, 167.0 / 255.0],
};

/// Draws where two drawings differ.
pub(crate) struct Difference {
    layout: BindGroupLayout,
    pipeline: RenderPipeline,
}

impl Difference {
    pub(crate) fn new(device: &Device) -> Self {
        let entries = [0, 1, 2].map(|binding| texture(binding, UNFILTERED));
        let layout = layout(device, "difference", &entries);
        let pipeline = PipelineRecipe::full_screen(SHADER, &[Some(&layout)], &[]).build(device);
        Self { layout, pipeline }
    }

    /// Draws the samples of `into`, over those of the first drawing's picture. All three have as many samples.
    pub(crate) fn draw(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        first: &Targets,
        second: &Targets,
        into: &Picture,
    ) {
        let views = [&first.roads.labels.view, &second.roads.labels.view, first.picture.drawn()];
        let bound = textures(gpu, &self.layout, &views);
        full_screen(encoder, "difference", into.drawn(), &self.pipeline, &[&bound]);
    }
}
