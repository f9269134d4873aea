//! Clips polylines to a tile, drapes them on its TIN (GEO), extrudes them (SV).
//!
//! ```text
//!   Polyline ──clip──► Polylines in the tile ──drape──► DrapedLines ──positions──► metres above the lattice
//!      └──clip_closed, tile and margin──► Polylines ──extrude──► SvLines
//! ```
//!
//! Every decision (on which side, which edge first, whether on the ground) is exact integer
//! arithmetic on the lattice; floating point only measures the results.
//!
//! This example drapes a line on two triangles, and computes the height of the ground at a point:
//!
//! ```
//! use corniche_drape::{drape, positions};
//! use corniche_geom::{LatticePoint, Polyline};
//! use corniche_tin::{Placement, Surface, Tin, TinVertex};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! //   100 m ─── 104 m     Four nodes, ten steps of the lattice apart; heights are whole steps of half a metre.
//! //     │ ╲       │       The line goes from the lower left to the upper right.
//! //     │   ╲     │
//! //     │     ╲   │
//! //   102 m ─── 110 m
//! let node = |row, column, height_m: i32| TinVertex { row, column, height_q: 2 * height_m };
//! let nodes = vec![node(0, 0, 100), node(0, 1, 104), node(1, 0, 102), node(1, 1, 110)];
//! let tin = Tin::new(nodes, &[[0, 2, 3], [0, 3, 1]])?;
//! let corner = LatticePoint::new(0, 0); // the north-west
//! let surface = Surface::new(&tin, Placement { corner, node_steps: [10, 10], quantum_m: 0.5 });
//!
//! let line = Polyline::new(vec![LatticePoint::new(2, -8), LatticePoint::new(8, -2)])?;
//! let laid = drape(&line, &surface);
//! assert!(laid.gaps.is_empty(), "there is ground everywhere");
//! // Two points of the line, and between them the one where it crosses the edge of the two triangles.
//! let vertices = positions(&laid.lines[0], &surface)?;
//! let expected = [[2.0, -8.0, 103.2], [5.0, -5.0, 105.0], [8.0, -2.0, 104.4]];
//! for (found, expected) in vertices.as_flattened().iter().zip(expected.as_flattened()) {
//!     assert!((found - expected).abs() < 1e-9, "{found}, not {expected}");
//! }
//!
//! // The ground at a point; outside there is none.
//! let point = LatticePoint::new(5, -9);
//! let triangle = surface.locate(point).ok_or("no ground")?;
//! let height_m = surface.height_at_point_m(triangle, point);
//! assert!((height_m - 105.8).abs() < 1e-9);
//! assert_eq!(surface.locate(LatticePoint::new(11, 0)), None);
//! # Ok(())
//! # }
//! ```
//!
//! This crate never knows the meaning of a line, and never reads a file.

mod draped_line;
mod owned_borders;

mod clip;
mod clip_region;
mod drape;
mod draped_line_check;
mod line_positions;

mod extrude;
mod near_ground;
mod road_bed;

mod barycentric;
mod cut_polygon;
mod fraction;
mod height_range;
mod ray;
mod segment_rectangle;

pub use clip::{ClippedPart, clip, clip_closed, clip_parts, clip_parts_within};
pub use clip_region::clip_region;
pub use drape::{Drape, Gap, drape, drape_within};
pub use draped_line::{DrapedLine, DrapedVertex, SvLine};
pub use draped_line_check::check;
pub use extrude::{extrude, extrude_within};
pub use line_positions::{BadLine, positions, source_segments};
pub use near_ground::{NearGround, near_ground};
pub use owned_borders::{Neighbours, OwnedBorders};
pub use road_bed::{GroundSegment, RoadBed, road_bed};

#[cfg(test)]
mod oracle_tests;
