//! The steps of a build. Each makes what is not yet in the store, and may be done again, by any process, for any subtree.
//!
//! ```text
//!  hashes   ways ─► nodes ─► roads ─┐      (build leaves out ways and nodes: roads reads the extract itself)
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
