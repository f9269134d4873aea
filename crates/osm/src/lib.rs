//! `OpenStreetMap` extracts (`.osm.pbf`) to roads, areas and boundaries, all in one reading.
//!
//! ```text
//!  blobs with relations ──► find_objects ──► objects of areas and boundaries, ids of the ways that they name
//!  blobs with ways ───────► find_ways ─────► WayRecord of each layer by way id ──► number_nodes ──► Mention by node id ─┐
//!                                                                                     │                               ▼
//!                                                                what the ways are ◄──┘   blobs with nodes ──► locate_nodes
//!                                                                      │                                              │
//!  Road, Area, ClassedLine: by layer, each in order of ids ◄───── hand_out ◄── Stop in the order of the ways ◄────────┘
//!
//!  blob ──► unpack, within its limit ──► audit ──► block: nodes and ways read in place; relations by osmpbf
//! ```
//!
//! Of an extract that is sorted by kind each blob is unpacked once, whatever layers are wanted: relations first, nodes last
//! (`read_extract`, `nodes_last`). Blobs are decoded in parallel inside the pool of the caller. No block is read before it was checked: what
//! contradicts itself, would overflow or would fill the memory is refused with its reason. Ways and nodes of roads are sorted
//! and joined within the memory that the caller allows; what does not fit goes to scratch space. There is one way through the
//! code for extracts of every size and order, but for the lengths of ways that are left out (`left_out_lengths`).
//!
//! Several extracts are read as one list of blobs. Of an object that is in two of them the newer version counts.
//!
//! The two passes can also be split into shares of the blobs and made by several processes, each a [`Share`].
//!
//! This crate never judges which road matters at which level, never guesses a class, and starts no threads.

mod areas;
mod header_bounds;
mod layer_sink;
mod layers;
mod lines;
mod outlines;
mod read_extract;
mod read_request;
mod reading;

mod share;
mod shares;

mod deferred;
mod find_ways;
mod hand_out;
mod left_out_lengths;
mod locate_nodes;
mod looked;
mod nodes_last;
mod number_nodes;
mod object_info;

mod audit;
mod blob;
mod blobs;
mod block;
mod extracts;
mod formats;
mod open_file;
mod packed;
mod wire;

mod assemble;
mod id_index;
mod id_range;
mod location;
mod nodes;
mod search;
mod self_crossings;
mod sought_ids;
mod to_and_fro;
mod versions;
mod ways;

mod ahead;
mod records;
mod spool;
mod text;
mod way_bytes;
mod way_facts;

mod area_loss;
mod defect;
mod error;
mod failed;
mod kept_error;
mod line_loss;
mod summary;

pub use area_loss::AreaLoss;
pub use areas::{AreaSummary, KeptAreas};
pub use defect::Defect;
pub use error::ReadOsmError;
pub use header_bounds::header_bounds_deg;
pub use kept_error::KeptError;
pub use layer_sink::{LayerSink, NamesSink};
pub use layers::{Layers, LinesSink};
pub use line_loss::LineLoss;
pub use lines::{ClassedLine, LineSummary};
pub use read_extract::{read_extract, read_extract_from};
pub use read_request::{OnProgress, ReadRequest, RingArea, ToLattice};
pub use share::{Share, ShareError};
pub use shares::{Kept, KeptKinds, keep_nodes, keep_ways, read_kept_roads};
pub use summary::{ATTRIBUTION, ExtractSummary, HighwayCount, LeftOut, LeftOutReason, LeftOutWays};
