//! Heights of the elevation files, judged and read: for the build, and once more for `verify`.

pub mod finest;
pub mod near;
pub mod patch;
pub mod pyramid;
pub mod rasters;
pub mod upwards;
