//! The steps of a build. Each step creates the artifacts that are missing from the store. Any
//! process may run it again, for any subtree.
//!
//! ```text
//!  hashes   ways ─► nodes ─► roads ─┐      (build skips ways and nodes: roads reads the extract itself)
//!  heights ─► top ─► tiles ─────────┴─► merge
//! ```

pub(crate) mod coarse_tiles;
pub(crate) mod hashes;
pub(crate) mod heights;
pub(crate) mod manifest;
pub(crate) mod merge;
pub(crate) mod photos;
pub(crate) mod recorded_tiles;
pub(crate) mod roads;
pub(crate) mod shares;
pub(crate) mod tiles;
pub(crate) mod top;
