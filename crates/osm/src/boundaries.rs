//! Boundaries of extracts: the ways that relations and their own tags make boundaries, each once.
//!
//! ```text
//!  objects and their located ways (`outlines`) ──► members by way id ──┐
//!                                                                      ├──► Boundary by way id
//!                                                  class of each object ┘
//! ```

mod boundary;
mod make_boundaries;
mod read_boundaries;
mod summary;

pub use boundary::Boundary;
pub(crate) use read_boundaries::hand_out_boundaries;
pub use read_boundaries::read_boundaries;
pub use summary::BoundarySummary;
