//! What is read of the extract, and kept for tiles.

pub mod kept;
mod no_road;
pub mod partition;
pub mod placed_reading;
