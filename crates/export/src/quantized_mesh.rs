//! A package's ground as quantized-mesh 1.0, the terrain tiles of CesiumJS, with layer.json.
//!
//! ```text
//!   tile of the globe's grid ──► raster of places ──► heights of the package's finest ground ──► voids filled ──► TIN ──► bytes
//!                                                                 │                                            │
//!                                                                 └───────────► deviation, measured ◄──────────┘
//! ```
//!
//! The grid of tiles is that of the globe rather than the package's, so heights are sampled again.
//! Each level follows the finest ground to the error that CesiumJS assumes for it: the format has
//! no field for an error.
//!
//! Source: Cesium, *quantized-mesh-1.0 terrain format*,
//! <https://github.com/CesiumGS/quantized-mesh>.

mod available;
mod comparison;
mod encode;
mod facets;
mod ground;
mod horizon;
mod layer;
mod mesh;
mod plan;
mod quantized_mesh_request;
mod raster;
mod tiling;
mod write_tiles;

pub use quantized_mesh_request::{
    Availability, MeshLevelPlan, QuantizedMeshLevel, QuantizedMeshPlan, QuantizedMeshRequest,
    QuantizedMeshSummary,
};
pub use tiling::Tiling;
pub use write_tiles::export_quantized_mesh;
