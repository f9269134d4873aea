//! Points of a layer: nodes with tags of the table, and places inside closed ways and relations.
//!
//! ```text
//!  blobs with nodes ──► outlines ─────► ObjectRecord of nodes by id ──┐
//!                                                                     ├──► LayerPoint: nodes, ways, relations
//!                        areas (`areas`) ──► a place inside each ─────┘
//! ```

mod hand_out_points;
mod isolation;
mod layer_point;

pub(crate) use hand_out_points::hand_out_points;
pub use layer_point::{LayerPoint, PointSummary};
