//! A package as 3D Tiles 1.1: explicit tilesets of binary glTF, with roads cut into the ground.
//!
//! ```text
//!   tile of the package ──► lines of it and its neighbours ──► ribbons ──► cut into the triangles ──► long edges divided
//!                                                                                                        │
//!   tileset.json ◄── boxes and errors from the finest level upwards ◄── GLB ◄── placed on the globe ◄────┘
//! ```
//!
//! Roads as vector content are a separate tileset, in a subfolder, with the same tree: CesiumJS
//! (1.145) treats either all of a tileset as vectors or nothing.
//!
//! All tiles are in one coordinate frame (east, north and up in the middle of the data), so one
//! matrix transforms to the earth's frame, and vertices that two tiles of a level share have the
//! same bits.

mod content;
mod glb;
mod parts;
mod placed;
mod tree;
mod vector_style;
mod write_tileset;

pub use content::{TileRoads, Tiles3dRequest};
pub use write_tileset::{Tiles3dLevel, Tiles3dSummary, export_tiles3d};
