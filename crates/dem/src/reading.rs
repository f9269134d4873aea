//! Reads heights from the files: windows of nodes, and the DEM's own samples.

pub(crate) mod fill_voids;
pub(crate) mod reader;
pub(crate) mod sample_surface;
pub(crate) mod samples;
pub(crate) mod window_parts;
