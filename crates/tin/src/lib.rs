//! Height grid → TIN within an error bound.
//!
//! This crate never sees a road or a file.

mod surface;
mod tin;

pub use surface::{NO_TWIN, Placement, Surface};
pub use tin::{Tin, TinError, TinVertex};
