//! Boundaries of the extract: their lines by tile.

pub(crate) mod layer;
pub(crate) mod split;
