//! Converts a grid of heights to a TIN (triangulated irregular network) within an error bound.
//!
//! [`triangulate`] converts the heights of one tile to a [`Tin`]; [`normals`] computes normals at
//! its vertices; [`TriangleBuckets`] and [`measure`] compare it with finer heights; [`heights_m`]
//! computes its own heights; [`Surface`] places it on the lattice.
//!
//! This crate never reads a road or a file, and never uses the result of a neighbouring tile: what
//! two tiles share, they both compute from the same nodes.

mod tin;
mod triangulate;

mod boundary;
mod candidate_queue;
mod face_scan;
mod fixed_mesh;
mod half_edges;
mod lanes;
mod node;
mod refine;
mod tile_raster;
mod to_tin;
mod triangle_rows;

mod deviation;
mod normals;
mod surface;

pub use deviation::{Deviation, TriangleBuckets, WindowPlacement, heights_m, measure};
pub use normals::{decode_normal, gradient, normal_shift, normals};
pub use surface::{NO_TWIN, Placement, Surface};
pub use tin::{Tin, TinError, TinVertex};
pub use triangulate::{TinSpec, TriangulateError, height_quantum_m, triangulate};
