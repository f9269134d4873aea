//! The ground of a build: heights and photos from files, or a package as the source of both.
//!
//! ```text
//!   elevation files ─► patches ─► heights of finest tiles ─► rasters of coarse ones
//!   photos ─► textures of finest tiles ─► those of coarse ones
//!   package ─► TINs, reliefs and textures as they are
//! ```
//!
//! This crate neither triangulates nor reads roads.

pub mod heights;
pub mod photos;
pub mod terrain;

mod error;

pub use error::{GroundError, TerrainError};
