//! Objects of layers that ways outline: areas, lines, and points inside closed ways.
//!
//! ```text
//!  blobs with relations ──► find_objects ──► ObjectRecord by id ──────────────► numbered ──► MemberRecord by way id
//!                                │ ids of ways                                                       │
//!  blobs with nodes ────────► found_nodes ──► ObjectRecord of nodes
//!  blobs with ways ─────────► find_ways ──► ObjectRecord of ways, WayRecord ──► LocatedWays ─────────┴──► areas, lines
//! ```
//!
//! Everything is sorted and joined within the caller's memory limit, as for roads.

pub(crate) mod find_objects;
pub(crate) mod found;
pub(crate) mod found_nodes;
pub(crate) mod judge;
pub(crate) mod located_ways;
pub(crate) mod member_ways;
pub(crate) mod number_objects;
pub(crate) mod records;
pub(crate) mod wanted;
