//! What an area is: a class from tags, and polygons from the ways of its outline.
//!
//! ```text
//!  tags ──► AreaTable::classify ──► class, or none
//!  ways ──► segments ──► planar graph ──► faces ──► polygons: an outer ring, holes
//!           (doubled ones   (half-edges,    (inside by the
//!            cancel out)     sorted by angle)  even-odd rule)
//! ```
//!
//! All of it is exact: points lie on an integer lattice, and no point is computed.
//!
//! This crate never sees terrain, a tile or a file, and never moves a point.

mod area;
mod area_class;
mod area_table;
mod assemble;
mod polygon;

mod faces;
mod planar_graph;
mod segments;
mod stabbing;

pub use area::{Area, AreaObject};
pub use area_class::AreaClass;
pub use area_table::{AreaTable, AreaTableError};
pub use assemble::{Assembled, OutlineError, OutlineWay, assemble};
pub use polygon::{Polygon, Ring};
