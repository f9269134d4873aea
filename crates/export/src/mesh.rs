//! The ground of a level, with its roads as lines, as a model for 3D programs: GLB, PLY, OBJ.
//!
//! ```text
//!   tiles of a level ──► ground in local metres, road lines or surfaces ──► a writer for each format ──► one file
//! ```
//!
//! Memory holds one tile, and where tiles meet. Positions are those of the package: nothing is simplified or moved.

mod glb;
mod local;
mod model;
mod obj;
mod ply;
mod request;
mod run;
mod spill;
mod weld;
mod writer;

pub use self::{
    request::{MeshFormat, MeshRequest, ModelRoads, UpAxis},
    run::{MeshSummary, export_mesh},
};
