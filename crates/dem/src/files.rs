//! One elevation file: how it is opened, what it says about itself, and its samples as metres.

pub(crate) mod named_files;
pub(crate) mod open_options;
pub(crate) mod source;
pub(crate) mod stand_in;

pub(crate) mod georeference;
pub(crate) mod open;
pub(crate) mod stored_values;

pub(crate) mod file_blocks;
pub(crate) mod raster_files;
pub(crate) mod vsi;
