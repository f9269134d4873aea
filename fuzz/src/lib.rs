//! One function for each reader of foreign bytes. It panics if an input makes the reader break a
//! promise.
//!
//! ```text
//!  corpus/NAME, regressions/NAME ──► tests/it/replay.rs ──┐
//!                                                      ├──► this crate's function NAME
//!  libFuzzer ──► fuzz_targets/NAME.rs ─────────────────┘
//! ```
//!
//! This crate never reads a user's file, and is not part of any binary.

mod config;
mod drape;
mod layers;
mod osm;
mod package;
mod payload;
mod vectors;

pub use config::{settings, styles};
pub use drape::drape;
pub use layers::{layer_coding, layers};
pub use osm::osm;
pub use package::{package, package_of};
pub use payload::payload;
pub use vectors::{overlay, polygon};
