//! Clip polylines to a tile, lay them on its TIN (GEO), extrude them (SV).
//!
//! ```text
//!   Polyline ──clip──► Polylines in the tile ──drape──► DrapedLines ──positions──► metres above the lattice
//!      └──clip_closed, tile and margin──► Polylines ──extrude──► SvLines
//! ```
//!
//! Every decision, on which side, which edge first, whether on the ground, is exact integer arithmetic on
//! the lattice; floating point only measures what has been decided.
//!
//! This crate never knows what a line means, and never reads a file.

mod draped_line;
mod owned_borders;

mod clip;
mod clip_area;
mod drape;
mod draped_line_check;
mod line_positions;

mod extrude;
mod near_ground;
mod road_bed;

mod cut_polygon;
mod fraction;
mod height_range;
mod ray;
mod segment_rectangle;

pub use clip::{ClippedPart, clip, clip_closed, clip_parts, clip_parts_within};
pub use clip_area::clip_area;
pub use drape::{Drape, Gap, drape};
pub use draped_line::{DrapedLine, DrapedVertex, SvLine};
pub use draped_line_check::check;
pub use extrude::extrude;
pub use line_positions::{BadLine, positions, source_segments};
pub use near_ground::{NearGround, near_ground};
pub use owned_borders::{Neighbours, OwnedBorders};
pub use road_bed::{RoadBed, RoadPiece, road_bed};

#[cfg(test)]
mod oracle_tests;
