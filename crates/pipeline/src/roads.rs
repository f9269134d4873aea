//! Roads of the extract, split into pieces by tile and laid on tiles: for the build, and once more for `verify`.

pub(crate) mod counts;
pub(crate) mod ground_lines;
pub(crate) mod lay;
pub(crate) mod layer;
pub(crate) mod losses;
pub(crate) mod near_spans;
pub(crate) mod overlap;
pub(crate) mod pieces;

pub(crate) mod shares;
pub(crate) mod split;
pub(crate) mod totals;
mod varints;
