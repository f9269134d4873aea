//! Clip polylines to a tile, lay them on its TIN (GEO), extrude them (SV).
//!
//! This crate never knows what a line means.

mod draped_line;

pub use draped_line::{DrapedLine, DrapedVertex, SvLine};
