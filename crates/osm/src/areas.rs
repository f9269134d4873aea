//! Areas of extracts: closed ways and relations with tags of the table.
//!
//! ```text
//!  blobs ──► find_objects ──► ObjectRecord by id ──► number ──► MemberRecord by way id ──┐
//!                                  │                                                     ▼
//!                                  │            blobs with ways ──► find_outlines ──► WayRecord
//!                                  │                                                     │
//!                                  │      blobs with nodes ──► number_nodes, locate_nodes (as for roads)
//!                                  ▼                                                     ▼
//!  Area, ways first, by id ◄── make_areas ◄──────────── OutlineWayRecord by object ◄────── hand_parts
//! ```
//!
//! Everything is sorted and joined within the memory that the caller allows, as for roads.

pub(crate) mod find_objects;
pub(crate) mod find_outlines;
mod hand_parts;
pub(crate) mod located_ways;
mod make_areas;
pub(crate) mod outline_ways;
mod over_seam;
mod read_areas;
pub(crate) mod records;
mod summary;
pub(crate) mod wanted;

pub use read_areas::read_areas;
pub use summary::{AreaSummary, KeptAreas};
