//! Code that tests, benchmarks and examples of several crates share: generated extracts, packages
//! and rasters, projections of closed form, reproducible random numbers, and the paths of sample
//! data.
//!
//! No product crate depends on this crate except under `[dev-dependencies]`; `tidy` checks this. A
//! unit test in `src/` of a crate must not use functions from here that return types of the same
//! crate: it would see two versions of them.
//!
//! Two kinds of code stay next to their test: oracles, which must share nothing with each other or
//! with the tested code, and code that only one crate needs.
#![allow(
    clippy::unwrap_used,
    clippy::missing_panics_doc,
    clippy::print_stderr,
    reason = "this is test code: it may unwrap, and prints what is skipped"
)]

mod area_extract;
mod boundary_extract;
mod coast_extract;
#[cfg(feature = "rasters")]
mod colour_image;
mod data;
#[cfg(feature = "disks")]
pub mod disks;
#[cfg(feature = "hostile")]
pub mod hostile;
mod lengths;
#[cfg(feature = "disks")]
mod memory_scratch;
#[cfg(feature = "packages")]
pub mod package;
pub mod payload;
pub mod pbf;
#[cfg(feature = "pictures")]
pub mod pictures;
pub mod pmtiles;
mod projection;
mod random;
#[cfg(feature = "rasters")]
mod raster;
mod skip;
mod tier;
#[cfg(feature = "tins")]
mod tins;

pub use area_extract::extract_with_areas;
pub use boundary_extract::extract_with_boundaries;
pub use coast_extract::extract_with_coast;
#[cfg(feature = "rasters")]
pub use colour_image::ColourImage;
pub use data::{real_data, root, sample, srtm_heights};
pub use lengths::length_steps;
#[cfg(feature = "disks")]
pub use memory_scratch::MemoryScratch;
pub use projection::FlatProjection;
pub use random::Random;
#[cfg(feature = "rasters")]
pub use raster::{Raster, raster_creation_options};
pub use skip::skip;
pub use tier::{Tier, cases, is_full, some_of};
#[cfg(feature = "tins")]
pub use tins::{check_covers_ground, check_tin};
