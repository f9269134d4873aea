//! Roads of the extract, split into pieces by tile and laid on tiles: for the build, and once more for `verify`.

pub(crate) mod counts;
mod defects;
pub(crate) mod extract;
pub(crate) mod lay;

pub(crate) mod losses;
mod no_road;
pub(crate) mod overlap;
pub(crate) mod partition;
pub(crate) mod pieces;

pub(crate) mod shares;
mod split;
pub(crate) mod totals;
mod varints;
