//! What all glTF files have in common: the binary container (a header, a document and one chunk of
//! bytes), numbers that glTF takes from OpenGL, and how slabs of bridges look.
//!
//! Source: Khronos Group, *glTF 2.0 Specification*, sections 3.6 and 4.4.

use std::io::{self, Write};

use corniche_styles::Rgb;
use serde_json::{Value, json};

const HEADER_BYTES: u64 = 12;
const CHUNK_HEADER_BYTES: u64 = 8;

/// The length of a chunk is a multiple of this.
pub(crate) const CHUNK_ALIGNMENT: usize = 4;

/// Writes a binary glTF: its document, and `length` bytes, a multiple of [`CHUNK_ALIGNMENT`], that `put` writes.
pub(crate) fn write_container<W: Write + ?Sized>(
    into: &mut W,
    document: &Value,
    length: u64,
    put: impl FnOnce(&mut W) -> io::Result<()>,
) -> io::Result<()> {
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(CHUNK_ALIGNMENT), b' ');
    let total = HEADER_BYTES + 2 * CHUNK_HEADER_BYTES + json.len() as u64 + length;
    let too_large = |_| io::Error::new(io::ErrorKind::FileTooLarge, "a GLB ends at 4 GiB");
    let number = |bytes: u64| u32::try_from(bytes).map(u32::to_le_bytes).map_err(too_large);
    into.write_all(b"glTF")?;
    into.write_all(&2_u32.to_le_bytes())?;
    into.write_all(&number(total)?)?;
    into.write_all(&number(json.len() as u64)?)?;
    into.write_all(b"JSON")?;
    into.write_all(&json)?;
    into.write_all(&number(length)?)?;
    into.write_all(b"BIN\0")?;
    put(into)
}

/// Target of a view of vertices.
pub(crate) const ARRAY_BUFFER: u32 = 34_962;
/// Target of a view of indices.
pub(crate) const ELEMENT_ARRAY_BUFFER: u32 = 34_963;
/// Component types.
pub(crate) const U8: u32 = 5121;
pub(crate) const U16: u32 = 5123;
pub(crate) const U32: u32 = 5125;
const F32: u32 = 5126;
/// Modes of primitives.
pub(crate) const LINES: u32 = 1;
pub(crate) const LINE_STRIP: u32 = 3;
pub(crate) const TRIANGLES: u32 = 4;

/// What an accessor of floats says, but for its view and its length.
pub(crate) fn floats(kind: &str) -> Value {
    json!({ "componentType": F32, "type": kind })
}

/// What an accessor of positions says, with their range.
pub(crate) fn positions(at: &[[f32; 3]]) -> Value {
    let [least, largest] = range_of(at);
    json!({ "componentType": F32, "type": "VEC3", "min": least, "max": largest })
}

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
fn range_of(vectors: &[[f32; 3]]) -> [[f32; 3]; 2] {
    [f32::min, f32::max].map(|pick: fn(f32, f32) -> f32| {
        [0, 1, 2].map(|axis: usize| {
            vectors.iter().map(|vector| vector[axis]).reduce(pick).unwrap_or(0.0)
        })
    })
}

/// The name of the material of slabs, but for the road on top.
pub(crate) const SLAB_NAME: &str = "bridge_slab";
/// Concrete, sRGB.
pub(crate) const SLAB_COLOR: Rgb = [0.62, 0.61, 0.59];
