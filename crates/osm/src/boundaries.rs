//! Boundaries of extracts: the ways that relations and their own tags make boundaries, each once.
//!
//! ```text
//!  objects and their located ways (`outlines`) ──► members by way id ──┐
//!                                                                      ├──► Boundary by way id
//!                                                  class of each object ┘
//! ```

mod boundary;
mod hand_out_boundaries;
mod make_boundaries;
mod summary;

pub use boundary::Boundary;
pub(crate) use hand_out_boundaries::hand_out_boundaries;
pub use summary::BoundarySummary;
