//! Lines that are not roads: draws the labels of one layer as colours over the picture.

use wgpu::{BlendState, Device};

use super::{
    super::{
        pipeline::{Shader, shader},
        shared_bindings::SharedLayouts,
    },
    composite::{bands, haze},
    label_colors::LabelColors,
};
use crate::{frame_view::FrameView, tiles::LineLayer};

pub(crate) const SHADER: Shader = shader!("lines": "common", "screen", "labelled", "lines");

/// Creates the pipeline that draws a layer over the samples of the picture. It runs after the
/// labels of roads, which it also reads. The frame's uniforms must be those of the layer, in which
/// the styles of lines replace the styles of roads.
pub(crate) fn line_colors(device: &Device, layouts: &SharedLayouts) -> LabelColors {
    let blend = Some(BlendState::ALPHA_BLENDING);
    LabelColors::new(device, layouts, (SHADER, "line_fragment"), blend, 1)
}

/// The block `struct LineColors` of `shaders/lines.wgsl`.
pub(crate) fn rows(view: &FrameView<'_>, layer: LineLayer) -> Vec<[f32; 4]> {
    let makes_room = if layer == LineLayer::Boundaries { 1.0 } else { 0.0 };
    let first = [haze(view), [makes_room, 0.0, 0.0, 0.0]];
    first.into_iter().chain(bands(view.style)).collect()
}
