//! Areas of the extract: to tiles of each level, and to their sections.

pub(crate) mod partition;
pub(crate) mod sea;
pub(crate) mod sections;
pub(crate) mod split;
pub(crate) mod totals;
