//! Coordinate systems, horizontal and vertical, and PROJ's operations between them. This module
//! opens no files.

pub(crate) mod cylindrical;
pub(crate) mod horizontal;
pub(crate) mod vertical;
pub(crate) mod wkt;

pub(crate) mod crs_text;

pub(crate) mod operation;
pub(crate) mod proj_operations;

pub(crate) mod datum_operation;
pub(crate) mod file_datums;

pub(crate) mod height_operation;
pub(crate) mod recorded;
pub(crate) mod recorded_heights;
pub(crate) mod scale;
