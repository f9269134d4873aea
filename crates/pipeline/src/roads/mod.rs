//! Roads of the extract, read and laid on tiles: for the build, and once more for `verify`.

pub(crate) mod by_tile;
pub(crate) mod counts;
pub(crate) mod lay;
pub(crate) mod lengths;
pub(crate) mod log;
pub(crate) mod losses;
pub(crate) mod read;
pub(crate) mod shares;
