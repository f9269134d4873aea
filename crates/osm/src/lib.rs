//! Reads roads and layers of areas, lines and points from `OpenStreetMap` extracts (`.osm.pbf`),
//! all in one reading.
//!
//! ```text
//! blobs with relations ──► find_objects ──► objects of layers, ids of the ways that they reference
//! blobs with ways ───────► find_ways ─────► WayRecord of each layer by way id ──► number_nodes ──►
//! Mention by node id ─┐
//!                                                                                     │                               ▼
//!                                                                what the ways are ◄──┘   blobs with nodes ──► locate_nodes
//!                                                                      │                                              │
//! LayerArea, LayerLine, LayerPoint, Road: each in order of ids ◄─── hand_out ◄── Stop in the order
//! of the ways ◄────────┘
//!
//! blob ──► unpack, within its limit ──► audit ──► block: nodes and ways read in place; relations
//! by osmpbf
//! ```
//!
//! In an extract that is sorted by type, each blob is unpacked once, whatever layers are requested:
//! relations first, nodes last (`read_extract`, `nodes_last`). Blobs are decoded in parallel in the
//! caller's thread pool. Each block is checked before it is read: a block that contradicts itself,
//! would overflow or would fill the memory is rejected with a reason. Ways and nodes of roads are
//! sorted and joined within the caller's memory limit; what does not fit goes to scratch space. The
//! same code reads extracts of every size and order, except for the lengths of skipped ways
//! (`left_out_lengths`).
//!
//! Several extracts are read as one list of blobs. If an object is in two of them, the newer
//! version counts.
//!
//! The two passes can also be split into shares of the blobs, which several processes read; see
//! [`Share`].
//!
//! This crate never judges which road matters at which level, never guesses a class, and starts no
//! threads.

mod areas;
mod header_bounds;
mod layer_sink;
mod layers;
mod lines;
mod outlines;
mod points;
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

mod defect;
mod error;
mod failed;
mod kept_error;
mod losses;
mod summary;

pub use areas::{AreaSummary, KeptAreas, LayerArea};
pub use defect::ExtractDefect;
pub use error::ReadOsmError;
pub use header_bounds::header_bounds_deg;
pub use kept_error::KeptError;
pub use layer_sink::LayerSink;
pub use layers::{LayerReceiver, Layers};
pub use lines::{LayerLine, LineSummary};
pub use losses::{AreaLoss, LineLoss};
pub use points::{LayerPoint, PointSummary};
pub use read_extract::{read_extract, read_extract_from};
pub use read_request::{OnProgress, ReadRequest, RingArea, ToLattice};
pub use share::{Share, ShareError};
pub use shares::{KeptKinds, ShareStore, keep_nodes, keep_ways, read_kept_roads};
pub use summary::{ATTRIBUTION, ExtractSummary, HighwayCount, LeftOut, LeftOutReason, LeftOutWays};
