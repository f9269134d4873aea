//! Areas of the extract: to tiles of each level, and to their sections.

pub(crate) mod data_outline;
pub(crate) mod extent;
pub(crate) mod layer;
pub(crate) mod sea;
pub(crate) mod split;
