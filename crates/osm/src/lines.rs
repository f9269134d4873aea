//! Lines of a layer: each way that gets a class from its own tags or from relations, once.
//!
//! ```text
//!  objects and their located ways (`outlines`) ──► members by way id ─────────────┐
//!                                                                                 ├──► LayerLine by way id
//!                                                  class and values of each object ┘
//! ```

mod hand_out_lines;
mod layer_line;
mod line_objects;

pub(crate) use hand_out_lines::hand_out_lines;
pub use layer_line::{LayerLine, LineSummary};
