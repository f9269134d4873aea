//! Spans, that is bridges and tunnels above and below the ground: their data in the extract, the
//! ground beneath them, and the runs stored in tiles.
//!
//! ```text
//!  pieces of roads ─► roads near spans ─► network ─► spans, crossings ─┐
//!  tiles ─► ground beneath bridges and tunnels, by tile ──────────────┴─► decks of each level ─► runs by tile
//! ```

pub mod outer_ground;
pub mod runs;
pub mod solving;
pub mod span_network;
pub mod totals;
