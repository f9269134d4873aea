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

mod around;
mod check;
mod clip;
mod draped_line;
mod extrude;
mod fraction;
mod near_ground;
mod owned_borders;
mod positions;
mod ray;
mod road_bed;
mod walk;

pub use check::check;
pub use clip::{ClippedPart, clip, clip_closed, clip_parts};
pub use draped_line::{DrapedLine, DrapedVertex, SvLine};
pub use extrude::extrude;
pub use near_ground::{NearGround, near_ground};
pub use owned_borders::{Neighbours, OwnedBorders};
pub use positions::{BadLine, positions, source_segments};
pub use road_bed::{RoadBed, RoadPiece, road_bed};
pub use walk::{Drape, Gap, drape};

#[cfg(test)]
mod oracle_tests;
