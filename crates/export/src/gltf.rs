//! What all glTF files have in common.
//!
//! Source: Khronos Group, *glTF 2.0 Specification*, sections 3.6 and 4.4.

mod container;
mod numbers;
mod slab_look;

pub(crate) use container::{CHUNK_ALIGNMENT, write_container};
pub(crate) use numbers::{
    ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, F32, LINE_STRIP, LINES, TRIANGLES, U8, U16, U32, linear,
    range_of, sampler,
};
pub(crate) use slab_look::{SLAB_COLOR, SLAB_NAME};
