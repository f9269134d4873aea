//! Lines that are not roads: draws their labels as colours over the picture.

use corniche_styles::LineStyle;
use wgpu::{BlendState, Device};

use super::{
    super::{
        pipeline::{Shader, shader},
        shared_bindings::SharedLayouts,
    },
    composite::{bands, haze},
    label_colors::LabelColors,
};
use crate::frame_view::FrameView;

pub(crate) const SHADER: Shader = shader!("lines": "common", "screen", "labelled", "lines");

/// Creates the pipeline that draws lines over the samples of the picture. It runs after the labels
/// of roads, which it also reads. The frame's uniforms must be those of these lines, in which the
/// styles of lines replace the styles of roads.
pub(crate) fn line_colors(device: &Device, layouts: &SharedLayouts) -> LabelColors {
    let blend = Some(BlendState::ALPHA_BLENDING);
    LabelColors::new(device, layouts, (SHADER, "line_fragment"), blend, 1)
}

/// The block `struct LineColors` of `shaders/lines.wgsl`.
pub(crate) fn rows(view: &FrameView<'_>, styles: &[LineStyle]) -> Vec<[f32; 4]> {
    let apart: [_; LineStyle::MOST] = std::array::from_fn(|style| {
        let is_apart = styles.get(style).is_some_and(|style| style.is_apart_from_roads);
        [if is_apart { 1.0 } else { 0.0 }, 0.0, 0.0, 0.0]
    });
    [haze(view)].into_iter().chain(apart).chain(bands(view.style)).collect()
}
