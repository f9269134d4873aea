//! Common parts of all glTF files: a document with the buffer of its views, the binary container (a
//! header, a document and one chunk of bytes), numbers that glTF takes from OpenGL, and the
//! material of bridge slabs.
//!
//! Source: Khronos Group, *glTF 2.0 Specification*, sections 3.6 and 4.4.

use std::io::{self, Write};

use corniche_styles::Rgb;
use serde_json::{Value, json};

const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;

/// The length of a chunk is a multiple of this number.
const CHUNK_ALIGNMENT: usize = 4;
/// The largest alignment that anything needs.
const MOST_ALIGNMENT: usize = 8;

/// Writes a binary glTF: its document, and the `length` bytes (a multiple of [`CHUNK_ALIGNMENT`])
/// that `put` writes.
pub(crate) fn write_container<W: Write + ?Sized>(
    into: &mut W,
    document: &Value,
    length: usize,
    put: impl FnOnce(&mut W) -> io::Result<()>,
) -> io::Result<()> {
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(CHUNK_ALIGNMENT), b' ');
    let total = HEADER_BYTES + 2 * CHUNK_HEADER_BYTES + json.len() + length;
    let too_large = |_| io::Error::new(io::ErrorKind::FileTooLarge, "a GLB ends at 4 GiB");
    let number = |bytes: usize| u32::try_from(bytes).map(u32::to_le_bytes).map_err(too_large);
    into.write_all(b"glTF")?;
    into.write_all(&2_u32.to_le_bytes())?;
    into.write_all(&number(total)?)?;
    into.write_all(&number(json.len())?)?;
    into.write_all(b"JSON")?;
    into.write_all(&json)?;
    into.write_all(&number(length)?)?;
    into.write_all(b"BIN\0")?;
    put(into)
}

/// A document with its buffer while it is composed.
pub(crate) struct Gltf<B> {
    /// The target of the buffer's bytes.
    pub(crate) bytes: B,
    /// The length of the buffer in bytes.
    pub(crate) length: usize,
    pub(crate) views: Vec<Value>,
    accessors: Vec<Value>,
    /// Textures have the same numbers as images.
    images: Vec<Value>,
}

impl<B: Write> Gltf<B> {
    pub(crate) fn new(bytes: B) -> Self {
        let (views, accessors, images) = (Vec::new(), Vec::new(), Vec::new());
        Self { bytes, length: 0, views, accessors, images }
    }

    /// Pads the buffer to a multiple of `alignment`, at most [`MOST_ALIGNMENT`].
    pub(crate) fn align(&mut self, alignment: usize) -> io::Result<()> {
        let end = self.length.next_multiple_of(alignment);
        self.bytes.write_all(&[0; MOST_ALIGNMENT][..end - self.length])?;
        self.length = end;
        Ok(())
    }

    /// Appends bytes, and records their position in `view`.
    pub(crate) fn put(&mut self, bytes: &[u8], view: &mut Value) -> io::Result<()> {
        view["buffer"] = json!(0);
        view["byteOffset"] = json!(self.length);
        view["byteLength"] = json!(bytes.len());
        self.bytes.write_all(bytes)?;
        self.length += bytes.len();
        self.align(CHUNK_ALIGNMENT)
    }

    /// Appends bytes as a view with these properties; returns the number of the view.
    pub(crate) fn view(&mut self, bytes: &[u8], mut view: Value) -> io::Result<usize> {
        self.put(bytes, &mut view)?;
        self.views.push(view);
        Ok(self.views.len() - 1)
    }

    /// Adds an accessor with these properties for `count` numbers of a view; returns its number.
    pub(crate) fn accessor(&mut self, mut accessor: Value, view: usize, count: usize) -> usize {
        accessor["bufferView"] = json!(view);
        accessor["count"] = json!(count);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds numbers with a view for this target and an accessor; returns the accessor's number.
    pub(crate) fn numbers<T: bytemuck::Pod>(
        &mut self,
        items: &[T],
        target: u32,
        accessor: Value,
    ) -> io::Result<usize> {
        // glTF is little-endian, and so is every supported machine.
        const { assert!(cfg!(target_endian = "little")) };
        let view = self.view(bytemuck::cast_slice(items), json!({ "target": target }))?;
        Ok(self.accessor(accessor, view, items.len()))
    }

    /// Adds an image with these properties; returns the number of its texture.
    pub(crate) fn picture(&mut self, bytes: &[u8], mut image: Value) -> io::Result<usize> {
        image["bufferView"] = json!(self.view(bytes, json!({}))?);
        self.images.push(image);
        Ok(self.images.len() - 1)
    }

    /// The whole document.
    pub(crate) fn document(
        &self,
        asset: &Value,
        (nodes, meshes): (&[Value], &[Value]),
        materials: &[Value],
    ) -> Value {
        let mut document = json!({
            "asset": asset,
            "scene": 0,
            "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }],
            "nodes": nodes,
            "meshes": meshes,
            "materials": materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.length }],
        });
        if !self.images.is_empty() {
            let textures = 0..self.images.len();
            document["samplers"] = json!([sampler()]);
            document["textures"] =
                textures.map(|source| json!({ "source": source, "sampler": 0 })).collect();
            document["images"] = json!(self.images);
        }
        document
    }
}

/// A material of one colour, sRGB.
pub(crate) fn material(name: &str, color: Rgb) -> Value {
    // Colours of styles are sRGB; glTF has linear ones.
    let [red, green, blue] = color.map(linear);
    json!({
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [red, green, blue, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0,
        },
    })
}

/// Converts east, north and up to the axes of glTF.
pub(crate) fn y_up<T: std::ops::Neg<Output = T>>([east, north, up]: [T; 3]) -> [T; 3] {
    [east, up, -north]
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

/// The properties of an accessor of floats, without its view and its length.
pub(crate) fn floats(kind: &str) -> Value {
    json!({ "componentType": F32, "type": kind })
}

/// The properties of an accessor of positions, with their range.
pub(crate) fn positions(at: &[[f32; 3]]) -> Value {
    let [least, largest] = range_of(at);
    json!({ "componentType": F32, "type": "VEC3", "min": least, "max": largest })
}

/// Filters and wrapping of samplers.
const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;
const CLAMP_TO_EDGE: u32 = 33_071;

/// The sampler for images of the ground: smooth, and clamped at the edge.
fn sampler() -> Value {
    json!({
        "magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR,
        "wrapS": CLAMP_TO_EDGE, "wrapT": CLAMP_TO_EDGE,
    })
}

/// A channel of sRGB as a linear one (IEC 61966-2-1).
pub(crate) fn linear(channel: f32) -> f32 {
    if channel <= 0.040_45 { channel / 12.92 } else { ((channel + 0.055) / 1.055).powf(2.4) }
}

/// The smallest and the largest value along each axis, as accessors of positions require them.
fn range_of(vectors: &[[f32; 3]]) -> [[f32; 3]; 2] {
    [f32::min, f32::max].map(|pick: fn(f32, f32) -> f32| {
        [0, 1, 2].map(|axis: usize| {
            vectors.iter().map(|vector| vector[axis]).reduce(pick).unwrap_or(0.0)
        })
    })
}

/// The name of the material of slabs, the road on top excepted.
pub(crate) const SLAB_NAME: &str = "bridge_slab";
/// Concrete, sRGB.
pub(crate) const SLAB_COLOR: Rgb = [0.62, 0.61, 0.59];
