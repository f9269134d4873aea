//! Areas of the extract: their distribution to the tiles of each level, and the sections of tiles.

pub mod layer;
pub(crate) mod sea;
