//! Files that GDAL opens: the files that a name means, their georeference, and their blocks.

pub(crate) mod named_files;
pub(crate) mod open;
pub(crate) mod vsi;

pub(crate) mod georeference;
pub(crate) mod placed_raster;
pub(crate) mod raster_files;
pub(crate) mod vector_files;
