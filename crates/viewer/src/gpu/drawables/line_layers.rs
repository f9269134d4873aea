//! Lines beside the roads: the labels of one layer into colours over the picture.

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

/// Draws a layer over the samples of the picture, after the labels of roads, which it reads, too. What is bound for the frame is that of the layer: its
/// styles have the places of roads.
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
