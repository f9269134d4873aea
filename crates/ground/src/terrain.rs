//! The ground of a build without elevation files: what an earlier package of the same terrain holds.
//!
//! ```text
//!   package ─► RecordedTerrain ─┬─► grid, levels, coordinates, counts   (from the manifest)
//!                               ├─► TIN, normals, deviations of a tile  (from its payload)
//!                               └─► which borders a tile owns           (from its TIN and those of its neighbours)
//! ```
//!
//! Nothing of a package that is made with it tells so: it has the same bytes as one made from the elevation files.

pub mod border_cells;
pub mod ground;
pub mod recorded;
pub mod recorded_grid;
