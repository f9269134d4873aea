//! The types of space: lattice points, frames, tiles, bounds, polylines and height grids.
//!
//! Values on which two tiles must agree to the last bit are integers here: nodes of the global grid
//! ([`NodeIndex`]) and points of the lattice ([`LatticePoint`]). Only a [`GridFrame`] converts them
//! to metres.
//!
//! This crate never knows a road, a file or a GPU.

mod along;
mod barycentric;
mod bounds;
mod cell;
mod coordinate_table;
mod disjoint_sets;
mod geo_transform;
mod grid_frame;
mod height_grid;
// This plain container knows nothing of triangles, although `tin` is its only user.
mod index_lists;
mod lattice;
mod lattice_region;
mod map_lines;
mod node;
mod orientation;
mod plan_records;
mod polyline;
mod projection;
mod region_shares;
mod seam;
mod tile_id;
mod tile_size;
pub mod wgs84;
mod work;

pub use along::along;
pub use barycentric::barycentric;
pub use bounds::{Bounds, LatticeBounds};
pub use cell::Cell;
pub use coordinate_table::{CoordinateTable, CoordinateTableError, width_factor};
pub use disjoint_sets::DisjointSets;
pub use geo_transform::GeoTransform;
pub use grid_frame::{GridFrame, GridFrameError, MAX_COORDINATE_M, MAX_LATTICE_STEPS};
pub use height_grid::HeightGrid;
pub use index_lists::IndexLists;
pub use lattice::LatticePoint;
pub use lattice_region::{LatticeRegion, doubled_area, ring_edges};
pub use map_lines::{Degrees, known_line_length_m, line_length_m, ring_area_m2};
pub use node::{NodeIndex, NodeWindow};
pub use orientation::{Side, cross, dot, side};
pub use plan_records::{ClipRecord, DatumOperationRecord, ScaleRecord};
pub use polyline::{Polyline, PolylineError};
pub use projection::{ProjectError, Projection};
pub use seam::{OnSeamedMap, Seam, split_at_seam};
pub use tile_id::{TileId, TileIdError};
pub use tile_size::{MAX_LEVEL, TILE_CELLS, TILE_NODES};
pub use work::{MOST_TILE_STEPS, StepBudget, TooMuchWork};
