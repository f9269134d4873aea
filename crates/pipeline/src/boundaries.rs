//! Boundaries of the extract: their lines by tile.

pub(crate) mod partition;
pub(crate) mod sections;
pub(crate) mod split;
pub(crate) mod totals;
