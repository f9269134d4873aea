//! Classified lines of extracts: each way that gets a class from relations or from its own tags,
//! once.
//!
//! ```text
//!  objects and their located ways (`outlines`) ──► members by way id ──┐
//!                                                                      ├──► ClassedLine by way id
//!                                                  class of each object ┘
//! ```

mod classed_line;
mod hand_out_lines;
mod line_names;
mod make_lines;
mod summary;

pub use classed_line::ClassedLine;
pub(crate) use hand_out_lines::hand_out_lines;
pub use summary::LineSummary;
