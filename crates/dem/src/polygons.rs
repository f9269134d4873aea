//! Polygons that say which part of the elevation data is wanted: read from vector files, carried to the working CRS and to the lattice.

pub(crate) mod image;
pub(crate) mod polygon;
