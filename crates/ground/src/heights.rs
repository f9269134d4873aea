//! Heights of the elevation files: checked and read for the build, and again for `verify`.

pub mod finest;
pub mod near;
pub mod patch;
pub mod pyramid;
pub mod rasters;
pub mod upwards;
