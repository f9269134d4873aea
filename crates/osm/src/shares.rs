//! The reading of an extract split into shares of its blobs, so that several processes can do it at
//! once.
//!
//! ```text
//!  share 1 of the blobs ──► ways ──► road ways, by id ─┬─► share 1 of the blobs with nodes ──► nodes ──► places, by id ─┐
//!  share 2 of the blobs ──► ways ──► road ways, by id ─┼─► share 2 of the blobs with nodes ──► nodes ──► places, by id ─┤
//!                                                      └────────────────────────────────────────────────────► roads ◄──┘
//! ```
//!
//! A share is the part between two bytes of the file, so "in the order of the file" means: in the
//! order of shares. The ways and nodes that a share finds are stored sorted by id, and merged by id
//! when they are read. The code that reads a whole extract does all later steps, so roads, defects,
//! counts and rejections are the same.

mod blocks;
mod kept;
mod kept_records;
mod merged;
mod nodes_of_share;
mod read_kept;
mod read_step;
mod ways_of_share;
mod ways_record;

pub use kept::{KeptKinds, ShareStore};
pub use nodes_of_share::keep_nodes;
pub use read_kept::read_kept_roads;
pub use ways_of_share::keep_ways;
