//! The terrain section: vertices, triangles, heights, normals.

pub(crate) mod record;

mod decode;
#[cfg(feature = "write")]
pub(crate) mod encode;

mod heights;
mod normals;
mod positions;
mod symbols;

pub(crate) use decode::{decode, record_in};
#[cfg(feature = "write")]
pub(crate) use encode::encode;
