//! Objects whose outlines are ways: areas and boundaries.
//!
//! ```text
//!  blobs with relations ──► find_objects ──► ObjectRecord by id ──────────────► numbered ──► MemberRecord by way id
//!                                │ ids of ways                                                       │
//!  blobs with ways ─────────► find_ways ──► ObjectRecord of ways, WayRecord ──► LocatedWays ─────────┴──► areas, boundaries
//! ```
//!
//! Everything is sorted and joined within the caller's memory limit, as for roads.

pub(crate) mod find_objects;
pub(crate) mod found;
pub(crate) mod judge;
pub(crate) mod located_ways;
pub(crate) mod member_ways;
pub(crate) mod number_objects;
pub(crate) mod records;
pub(crate) mod wanted;
