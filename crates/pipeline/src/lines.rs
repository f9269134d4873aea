//! Layers of lines of the extract: their parts by tile.

pub(crate) mod layer;
pub(crate) mod split;
