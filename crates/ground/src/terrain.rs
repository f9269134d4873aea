//! The ground of a build without elevation files: an earlier package with the same terrain provides
//! it.
//!
//! ```text
//!   package ─► RecordedTerrain ─┬─► grid, levels, coordinates, counts   (from the manifest)
//!                               ├─► TIN, normals, deviations of a tile  (from its payload)
//!                               └─► which borders a tile owns           (from its TIN and those of its neighbours)
//! ```
//!
//! The new package does not record where its terrain comes from: its bytes equal those of a build
//! from the elevation files.

pub mod border_cells;
pub mod ground;
pub mod recorded;
pub mod recorded_grid;
