//! Roads as surfaces of their true width, cut into the ground's own triangles.
//!
//! ```text
//!   lines of a tile and its neighbours ──► ribbons ──► cut into the triangles of the tile ──► triangles with labels
//! ```
//!
//! Tiles on both sides of a border see the same lines, so they have the same vertices on it.

mod cut;
mod divided;
mod ground;
mod label_index;
mod lines;
mod plan_cut;
mod ribbon;

#[cfg(test)]
pub(crate) use self::ground::GroundVertex;
pub(crate) use self::{
    divided::Divided,
    ground::{GroundMesh, across, unit},
    lines::{Road, RoadLook, TileLines},
};
