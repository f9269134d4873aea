//! All elevation files together: those of one grid as one raster, where they lie, and one vertical
//! CRS for all.

pub(crate) mod mosaic;
pub(crate) mod open_files;

pub(crate) mod data_extent;
pub(crate) mod vertical_target;
