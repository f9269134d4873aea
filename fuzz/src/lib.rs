//! What no input may break: one function per reader of foreign bytes, which panics when a promise is broken.
//!
//! ```text
//!  corpus/NAME, regressions/NAME ──► tests/replay.rs ──┐
//!                                                      ├──► this crate's function NAME
//!  libFuzzer ──► fuzz_targets/NAME.rs ─────────────────┘
//! ```
//!
//! This crate never reads a file of a user, and is part of no binary.

mod config;
mod drape;
mod osm;
mod package;
mod payload;

pub use config::config;
pub use drape::drape;
pub use osm::osm;
pub use package::{package, package_of};
pub use payload::payload;
