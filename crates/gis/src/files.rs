//! Files that GDAL opens: which a name means, where they lie on the earth, how they are cut into
//! blocks.

pub(crate) mod named_files;
pub(crate) mod open;
pub(crate) mod vsi;

pub(crate) mod georeference;
pub(crate) mod placed_raster;
pub(crate) mod raster_files;
pub(crate) mod vector_files;
