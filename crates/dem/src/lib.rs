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

mod audit;
mod crs;
mod files;
mod mosaics;
mod placed_raster;
mod plan;
mod polygons;
mod reading;

mod beside_program;
mod error;
mod file_names;
mod formats;
mod library_error;
mod polygon_error;
mod proj_folders;
mod vector_file;

pub use audit::{Audit, AuditBlock, AuditPart, Auditor, SURFACE_RANGE_M};
pub use beside_program::use_files_beside;
pub use crs::datum_operation::{BetterOperation, DatumOperation};
pub use crs::projection::DemProjection;
pub use crs::recorded::{ProjectedCrs, RecordedCrs};
pub use crs::recorded_heights::RecordedHeights;
pub use dem::{Dem, limit_block_cache, set_unless_set};
pub use error::DemError;
pub use file_names::listed_files;
pub use files::file_blocks::FileBlocks;
pub use files::named_files::{expand_extract_name, expand_name, expand_photo_name, unpack_name};
pub use files::open_options::OpenOptions;
pub use files::raster_files::raster_files;
pub use files::stand_in::stand_in;
pub use files::vsi::{VirtualFile, stored_text};
pub use formats::missing_formats;
pub use library_error::{LibraryError, failure, forget, quiet};
pub use placed_raster::{PlacedRaster, RasterOnGrid};
pub use plan::datum_operations::{FileDatums, ToWgs84};
pub use plan::footprint::Footprint;
pub use plan::grid_plan::{Clip, GridPlan, PlanOptions, PlanScale, Resampling};
pub use plan::planning::libraries;
pub use plan::recorded_grid::RecordedGrid;
pub use polygon_error::PolygonError;
pub use polygons::polygon::Polygon;
pub use reading::reader::{DemWindow, Reader};
pub use reading::sample_surface::{SampleSurface, largest_of_parabola};
pub use reading::samples::{SampleBlock, SampleRange};
pub use vector_file::{NotOpened, open_vectors};
