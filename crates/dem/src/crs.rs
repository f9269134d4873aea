//! Coordinate systems, horizontal and vertical, and PROJ's operations between them. Knows no file.

mod cylindrical;
pub(crate) mod horizontal;
pub(crate) mod vertical;
pub(crate) mod wkt;

pub(crate) mod compound;
pub(crate) mod working;

pub(crate) mod operation;
pub(crate) mod place_limit;
pub(crate) mod proj_operations;

pub(crate) mod datum_operation;

pub(crate) mod height_operation;
pub(crate) mod projection;
pub(crate) mod recorded;
pub(crate) mod recorded_heights;
pub(crate) mod scale;
