//! Roads as surfaces of their true width, cut into the ground's own triangles, and bridges as slabs
//! above it.
//!
//! ```text
//!   lines of a tile and its neighbours ──┬► ribbons ──► cut into the triangles of the tile ──┬► triangles with labels
//!   heights of its bridges ──► stretches ┴► slabs ───────────────────────────────────────────┘
//! ```
//!
//! Tiles on both sides of a border use the same lines, so they have the same vertices on it.

mod cut;
mod deck_ends;
mod divided;
mod ground;
mod lines;
mod plan_cut;
mod ribbon;
mod slab;
mod stretches;
mod wide_line;

#[cfg(test)]
pub(crate) use self::ground::SurfaceVertex;
pub(crate) use self::{
    divided::{Divided, SurfaceKind},
    ground::{LabelledMesh, across, by_first_use, unit},
    lines::{SurfaceLines, SurfaceRoads},
};
