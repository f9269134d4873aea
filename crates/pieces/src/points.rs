//! Points of layers: their distribution to the tiles of each level.

pub mod layer;
