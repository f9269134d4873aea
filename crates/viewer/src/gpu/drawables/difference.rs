//! Shows where the roads of two drawings differ.

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
    /// Colour of road in the first drawing only.
    pub first_only: Rgb,
    /// Colour of road in the second drawing only.
    pub second_only: Rgb,
    /// Colour of road in both, but of another class, or with a centre line in one of them.
    pub other_label: Rgb,
}

/// Vermilion, blue and reddish purple, which people with any kind of colour vision can distinguish.
///
/// Source: Okabe & Ito 2008, *Color Universal Design*. `shaders/difference.wgsl` has the same
/// numbers.
pub const DIFFERENCE_COLORS: DifferenceColors = DifferenceColors {
    first_only: [213.0 / 255.0, 94.0 / 255.0, 0.0],
    second_only: [0.0, 114.0 / 255.0, 178.0 / 255.0],
    other_label: [204.0 / 255.0, 121.0 / 255.0, 167.0 / 255.0],
};

/// Draws where two drawings differ.
pub(crate) struct DifferenceDrawable {
    layout: BindGroupLayout,
    pipeline: RenderPipeline,
}

impl DifferenceDrawable {
    pub(crate) fn new(device: &Device) -> Self {
        let entries = [0, 1, 2].map(|binding| texture(binding, UNFILTERED));
        let layout = layout(device, "difference", &entries);
        let pipeline = PipelineRecipe::new(SHADER, &[Some(&layout)], &[]).build(device);
        Self { layout, pipeline }
    }

    /// Draws the samples of `into`, over the picture of the first drawing. All three have the same
    /// number of samples.
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
