//! The areas of a map: polygons from the ways of their outlines.
//!
//! ```text
//!  ways ──► segments ──► planar graph ──► faces ──► polygons: an outer ring, holes
//!           (doubled ones   (half-edges,    (inside by the
//!            cancel out)     sorted by angle)  even-odd rule)
//!  coastlines ──► chains, cut by a region ──► closed along its edge ──► polygons of the sea
//!  Polygon ──► coarsen: for a level ──► divide: by lines between tiles ──► polygons
//! ```
//!
//! Assembling is exact: points are on an integer lattice, and no point is computed. Coarsening and
//! dividing round new points to the lattice, by rules that consider one segment or one point at a
//! time, so that neighbours agree.
//!
//! This crate never reads terrain or files.

mod assemble;
mod coarsen;
mod cut_out;
mod divide;
mod inside_point;
mod intersection;
mod outline;
mod over_seam;
mod polygon;
mod sea;

mod coastlines;
mod faces;
mod planar_graph;
mod region_edge;
mod segments;
mod stabbing;

#[cfg(test)]
mod chessboard_tests;

pub use assemble::{AssembledArea, assemble};
pub use coarsen::{coarsen, surrounded};
pub use coastlines::Coastline;
pub use cut_out::{cut_out, divide_all};
pub use divide::{Axis, divide};
pub use inside_point::inside_point;
pub use intersection::intersection;
pub use outline::{OutlineError, OutlineWay};
pub use over_seam::{split_polygon, unroll_rings};
pub use polygon::{Polygon, Ring};
pub use sea::{Sea, close_sea};
