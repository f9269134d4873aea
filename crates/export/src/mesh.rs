//! The ground of a level, with its roads as lines, as a model for 3D programs: GLB, PLY, OBJ.
//!
//! ```text
//!   tiles of a level ──► ground in local metres, road lines or surfaces ──► a writer for each format ──► one file
//! ```
//!
//! Memory contains one tile, and the seams between tiles. Positions are those of the package:
//! nothing is simplified or moved.

mod glb;
mod mesh_request;
mod model;
mod obj;
mod ply;
mod write_model;
mod writer;

pub use self::{
    mesh_request::{MeshFormat, MeshRequest, ModelRoads, UpAxis},
    write_model::{MeshSummary, export_mesh},
};
