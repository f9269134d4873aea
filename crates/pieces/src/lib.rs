//! The extract cut into pieces: what each tile of each level needs of its roads, areas, lines, bridges and tunnels.
//!
//! ```text
//!   extract ─► roads ─► pieces of tiles           ─┐
//!           ─► areas, lines ─► sections of tiles  ─┴─► store
//!           ─► bridges and tunnels ─► runs, once the ground is there
//! ```
//!
//! This crate makes no TIN; lines are laid on those that it is given.

pub mod areas;
pub mod extract;
pub mod layers;
pub mod lines;
pub mod roads;
pub mod spans;

mod error;

pub use error::ExtractError;
