//! Numbers that glTF takes from OpenGL: targets, component types, modes, filters.

use serde_json::{Value, json};

/// Target of a view of vertices.
pub(crate) const ARRAY_BUFFER: u32 = 34_962;
/// Target of a view of indices.
pub(crate) const ELEMENT_ARRAY_BUFFER: u32 = 34_963;
/// Component types.
pub(crate) const U8: u32 = 5121;
pub(crate) const U16: u32 = 5123;
pub(crate) const U32: u32 = 5125;
pub(crate) const F32: u32 = 5126;
/// Modes of primitives.
pub(crate) const LINES: u32 = 1;
pub(crate) const LINE_STRIP: u32 = 3;
pub(crate) const TRIANGLES: u32 = 4;

/// Filters and wrapping of samplers.
const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;
const CLAMP_TO_EDGE: u32 = 33_071;

/// How pictures of the ground are read: smoothly, and never across their edge.
pub(crate) fn sampler() -> Value {
    json!({
        "magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR,
        "wrapS": CLAMP_TO_EDGE, "wrapT": CLAMP_TO_EDGE,
    })
}

/// A channel of sRGB as a linear one (IEC 61966-2-1).
pub(crate) fn linear(channel: f32) -> f32 {
    if channel <= 0.040_45 { channel / 12.92 } else { ((channel + 0.055) / 1.055).powf(2.4) }
}

/// The smallest and the largest of each axis, as accessors of positions say them.
pub(crate) fn range_of(vectors: &[[f32; 3]]) -> [[f32; 3]; 2] {
    [f32::min, f32::max].map(|pick: fn(f32, f32) -> f32| {
        [0, 1, 2].map(|axis: usize| {
            vectors.iter().map(|vector| vector[axis]).reduce(pick).unwrap_or(0.0)
        })
    })
}
