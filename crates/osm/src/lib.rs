//! `OpenStreetMap` extracts (`.osm.pbf`) to roads.
//!
//! ```text
//!  file ──► blobs ──► ways (pass 1) ──► ids of the nodes they need, sorted
//!                └──► nodes (pass 2) ──► their locations ──► assemble ──► Road, in order of way id
//!
//!  blob ──► unpack, within its limit ──► audit ──► osmpbf ──► objects
//! ```
//!
//! Both passes decode blobs in parallel inside the pool of the caller. No block reaches the decoder before it was checked: what
//! contradicts itself, would overflow or would fill the memory is refused with its reason. Only what roads need is held: their
//! tags, their node ids and those nodes' coordinates, whatever the order of the file.
//!
//! This crate never judges which road matters at which level, never guesses a class, and starts no threads.

mod read_request;
mod read_roads;

mod audit;
mod blob;
mod blobs;
mod formats;
mod wire;

mod assemble;
mod location;
mod nodes;
mod self_crossings;
mod versions;
mod ways;

mod defect;
mod error;
mod summary;

pub use defect::Defect;
pub use error::ReadOsmError;
pub use read_request::{Place, ReadRequest};
pub use read_roads::{read_roads, read_roads_from};
pub use summary::{ATTRIBUTION, ExtractSummary, HighwayCount, LeftOut};
