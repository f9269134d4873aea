//! Cuts the extract into pieces: the roads, objects of layers, bridges and tunnels that each tile
//! of each level needs.
//!
//! ```text
//!   extract ─► roads ─► pieces of tiles           ─┐
//!           ─► layers ──────► sections of tiles  ─┴─► store
//!           ─► bridges and tunnels ─► runs, when the ground is complete
//! ```
//!
//! This crate creates no TINs; it drapes lines on the TINs that it receives.

pub mod areas;
pub mod extract;
pub mod layers;
pub mod lines;
pub mod points;
pub mod roads;
pub mod spans;

mod error;

pub use error::ExtractError;
