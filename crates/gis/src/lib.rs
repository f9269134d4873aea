//! The interface to GDAL and PROJ: all other crates open files and transform coordinates through
//! this crate.
//!
//! ```text
//!   names ──► files ──► PlacedRaster, open_vectors, Polygon          Crs ──► CrsOperation ──► coordinates
//!  (folders, patterns,  (drivers, georeference, blocks)      (horizontal, vertical, recorded by a package)
//!   lists, archives)
//! ```
//!
//! Code that only heights, photos or overlays need is in the crates `dem`, `photo` and `overlay`.
//! This crate knows no grid of heights, never uses GDAL's warper, and never guesses a coordinate
//! system.

mod error;
mod library_error;

mod formats;
mod libraries;
mod proj_folders;

mod crs;
mod files;
mod polygon;
mod polygon_image;

pub use crs::crs_text::crs_from_text;
pub use crs::datum_operation::{BetterOperation, DatumOperation};
pub use crs::file_datums::{FileDatums, ToWgs84, by_system};
pub use crs::height_operation::HeightOperation;
pub use crs::horizontal::{Crs, GridCrs};
pub use crs::operation::CrsOperation;
pub use crs::recorded::{DemProjection, ProjectedCrs, RecordedCrs};
pub use crs::recorded_heights::RecordedHeights;
pub use crs::scale::{LocalScale, SCALES, center_deg, scales};
pub use crs::vertical::{VerticalCrs, grid_names};
pub use error::{CrsError, FileUse, NameError, NotUtf8, PolygonError, RasterError, VectorError};
pub use error::{first_names, listed_files, names_up_to};
pub use files::georeference::Georeference;
pub use files::named_files::{SoughtFiles, expand_name, unpack_name};
pub use files::open::{OpenRasters, open_raster, stand_in};
pub use files::placed_raster::{PlacedRaster, RasterOnGrid};
pub use files::raster_files::{FileBlocks, has_own_mask, raster_files};
pub use files::vector_files::{for_each_feature, open_vectors};
pub use files::vsi::{VirtualFile, stored_text};
pub use formats::missing_formats;
pub use libraries::{libraries, limit_block_cache, set_unless_set, use_files_beside};
pub use library_error::{LibraryError, failure, forget, quiet};
pub use polygon::RegionPolygons;
