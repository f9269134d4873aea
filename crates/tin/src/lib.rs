//! Height grid → TIN within an error bound.
//!
//! [`triangulate`] turns the heights of one tile into a [`Tin`]; [`normals`] gives its vertices normals;
//! [`TriangleBuckets`] and [`measure`] compare it with finer heights, [`heights_m`] gives its own; [`Surface`] places it on the lattice.
//!
//! This crate never sees a road or a file, and never looks at a neighbouring tile's result: what two tiles
//! share they both compute from the same nodes.

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
