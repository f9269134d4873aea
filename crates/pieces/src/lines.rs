//! Layers of lines of the extract: their parts by tile.

pub mod layer;
