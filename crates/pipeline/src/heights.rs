//! Heights of the elevation files, judged and read: for the build, and once more for `verify`.

pub(crate) mod data_tiles;
pub(crate) mod finest;
pub(crate) mod near;
pub(crate) mod patch;
pub(crate) mod pyramid;
pub(crate) mod rasters;
pub(crate) mod upwards;
