//! Compares roads drawn by the GPU with two independent references, in f64 on the CPU.
//!
//! ```text
//!  depth and owner of each pixel, read back ──► O1: which class is the ground seen there? ──┐
//!  rays at the triangles that were drawn    ──► O2: the same, without the GPU's depth      ──┼─► disagreements
//!  centre-lines, walked in quarter pixels   ──► how much of them in view has no road       ──┘
//! ```
//!
//! Both references use the distance in plan to the lines of the tile that owns the pixel. A pixel
//! whose result would change within a band around it is skipped: 0.05 pixels for O1, which knows
//! the ground as the GPU does, half a pixel for O2. `cargo test -p corniche-viewer --test it oracle
//! -- --nocapture` prints the table of figures.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "this is test code, helpers included")]

use crate::support;

mod agreement;
mod areas;
mod class_scale;
mod decks;
mod from_above;
mod ground_rays;
mod level_steps;
mod measures;
mod metamorphic;
mod must_fail;
mod package;
mod points;
pub(crate) mod reference;
mod road_widths;
mod short_parts;
mod unmapped;
