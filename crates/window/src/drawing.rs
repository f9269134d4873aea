//! Lines and areas that a person draws on the ground: what they are, how they are changed, and how they come onto the tiles.
//!
//! ```text
//!  mouse, keys ──► Tool ──► Document (lines, undo, redo) ──► LaidLines ──► layers of the tiles that are shown
//!                              ▲            │
//!                       file ──┘            └──► file
//! ```

mod document;
mod laid;
mod smooth;
mod tool;
mod unchanged;

pub(crate) use self::{
    document::{Document, Line, Point},
    laid::LaidLines,
    tool::Tool,
    unchanged::Unchanged,
};
