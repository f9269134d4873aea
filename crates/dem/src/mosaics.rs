//! All elevation files together: files of one grid as one raster, their extent, and one vertical
//! CRS for all.

pub(crate) mod mosaic;
pub(crate) mod open_files;

pub(crate) mod data_extent;
pub(crate) mod vertical_target;
