//! The reading of an extract split into shares of its blobs, so that several processes can do it at once.
//!
//! ```text
//!  share 1 of the blobs ──► ways ──► road ways, by id ─┬─► share 1 of the blobs with nodes ──► nodes ──► places, by id ─┐
//!  share 2 of the blobs ──► ways ──► road ways, by id ─┼─► share 2 of the blobs with nodes ──► nodes ──► places, by id ─┤
//!                                                      └────────────────────────────────────────────────────► roads ◄──┘
//! ```
//!
//! A share is what lies between two bytes of the file, so "in the order of the file" means: in the order of shares. What is found of ways
//! and nodes is kept sorted by id, and the shares are merged by id when they are read. All that follows is done by the code that reads
//! an extract at once, so roads, defects, counts and refusals are the same.

mod blocks;
mod kept;
mod kept_records;
mod merged;
mod nodes_of_share;
mod read_kept;
mod ways_of_share;
mod ways_record;

pub use kept::{Kept, KeptKinds};
pub use nodes_of_share::keep_nodes;
pub use read_kept::read_kept_roads;
pub use ways_of_share::keep_ways;
