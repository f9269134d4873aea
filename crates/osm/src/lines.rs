//! Lines with classes of extracts: the ways to which relations or their own tags give one, each once.
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
