//! Reads elevation files as windows of heights on a package's global grid.
//!
//! ```text
//!   files ──► Dem::open ──► Dem::plan ──► Dem::reader ──► Reader::window ──► HeightGrid
//!            (georeference,  (working CRS,                (mosaic, units,
//!             CRS, units)     cell, extent)                interpolation, voids)
//! ```
//!
//! A node has the same height, bit for bit, in any window: its position comes from its global
//! index, its height from samples around this position, and a filled void from nodes around it.
//!
//! This crate never triangulates, never uses GDAL's warper, and never guesses what a sentinel, a
//! unit or a vertical datum means.

mod dem;
mod error;

mod audit;
mod files;
mod mosaics;
mod plan;
mod reading;

pub use audit::{Audit, AuditBlock, AuditPart, Auditor, SURFACE_RANGE_M};
pub use dem::Dem;
pub use error::{
    AuditError, DemError, GridError, HeightDatumError, OpenDemError, ReadHeightsError,
};
pub use files::stored_values::OpenOptions;
pub use plan::clip::nodes_within;
pub use plan::footprint::Footprint;
pub use plan::grid_plan::{GridPlan, MosaicRoles, PlanOptions, Resampling};
pub use reading::reader::{DemWindow, HeightReader};
pub use reading::sample_surface::{SampleSurface, largest_of_parabola};
pub use reading::samples::{SampleBlock, SampleRange};
