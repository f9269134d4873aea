//! Boundaries of extracts: the ways that relations and their own tags make boundaries, each once.
//!
//! ```text
//!  as for areas up to the located ways ──► members by way id ──┐
//!                                                              ├──► Boundary by way id
//!                                          class of each object ┘
//! ```

mod make_boundaries;
mod read_boundaries;
mod summary;

pub use read_boundaries::{Boundary, read_boundaries};
pub use summary::{BoundaryLoss, BoundarySummary};
