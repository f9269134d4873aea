//! Elevation files to windows of heights on a package's global grid.
//!
//! ```text
//!   files ──► Dem::open ──► Dem::plan ──► Dem::reader ──► Reader::window ──► HeightGrid
//!            (georeference,  (working CRS,                (mosaic, units,
//!             CRS, units)     cell, extent)                interpolation, voids)
//! ```
//!
//! A node has the same height, bit for bit, whichever window it is read through: its position comes from its
//! global index, its height from samples around that position, and a filled void from nodes around it.
//!
//! This crate never triangulates, never uses GDAL's warper, and never guesses what a sentinel, a unit or a vertical
//! datum means.

mod dem;
mod source;

mod audit;
mod files;
mod oversampling;
mod vsi;

mod plan;
mod reader;
mod samples;

mod crs;
mod heights;
mod values;
mod vertical;
mod wkt;

mod fill;
mod kernel;
mod mosaic;
mod operation;
mod outline;
mod positions;
mod projection;
mod recorded;
mod scale;
mod spacing;
mod turns;
mod working;

mod error;
mod library;

pub use audit::{Audit, AuditBlock, AuditPart, Auditor, SURFACE_RANGE_M};
pub use dem::{Dem, limit_block_cache};
pub use error::DemError;
pub use files::raster_files;
pub use library::LibraryError;
pub use plan::{GridPlan, PlanOptions, Resampling};
pub use projection::DemProjection;
pub use reader::{DemWindow, Reader, SampleBlock};
pub use recorded::RecordedCrs;
pub use samples::SampleArea;
pub use source::OpenOptions;
pub use vsi::VirtualFile;
pub use working::PlanScale;
