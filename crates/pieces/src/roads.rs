//! Roads of the extract, split into pieces by tile and draped on tiles: for the build, and again
//! for `verify`.

pub mod ground_lines;
pub mod lay;
pub mod layer;
pub mod losses;
pub mod near_spans;
pub mod overlap;
pub mod pieces;

pub mod proportions;
pub mod split;
pub mod totals;
