//! What is read of the extract, and kept for tiles.

pub(crate) mod kept;
mod no_road;
pub(crate) mod partition;
pub(crate) mod placed_reading;
