//! Boundaries of the extract, split by tile.

pub mod layer;
