//! Photos of the ground, of all levels.
//!
//! ```text
//!  files ─► texels of a finest tile ─┬─► texture ───────────────────────────► payload
//!                                    └─► raster, a texel for each cell ─► rasters of the levels above
//!                                                       └─ with those of neighbours ─► textures of coarse tiles ─► payloads
//! ```

pub mod rasters;
pub mod source;
pub mod textures;
