//! Areas of the extract: to tiles of each level, and to their sections.

pub mod layer;
pub(crate) mod sea;
