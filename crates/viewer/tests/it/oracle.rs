//! Roads on the graphics card against two references that share nothing with it, in f64 on the CPU.
//!
//! ```text
//!  depth and owner of each pixel, read back ──► O1: which class is the ground seen there? ──┐
//!  rays at the triangles that were drawn    ──► O2: the same, without the card's depth     ──┼─► disagreements
//!  centre-lines, walked in quarter pixels   ──► how much of them in view has no road       ──┘
//! ```
//!
//! Both answer by distance in plan to the lines of the tile that owns the pixel. A pixel whose answer would
//! change within a band around it is left out: 0.05 pixels for O1, which knows the ground as the card does, half a
//! pixel for O2. `cargo test -p corniche-viewer --test it oracle -- --nocapture` prints the table of figures.
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
pub(crate) mod reference;
mod road_widths;
mod short_parts;
mod unmapped;
