//! The request for quantized-mesh terrain tiles of a package, the plan of what will be written, and
//! the summary of what was.

use std::collections::BTreeSet;

use super::tiling::{TerrainTile, Tiling};
use crate::{bounds::DegreeBounds, places::FeatureCoordinates};

/// The part of a package that becomes terrain tiles, and the form of the tiles.
#[derive(Debug, Clone, PartialEq)]
pub struct QuantizedMeshRequest {
    /// The grid of tiles.
    pub tiling: Tiling,
    /// The finest level; `None` means the first one whose error is not above the package's, or
    /// whose cells are the package's.
    pub max_level: Option<u8>,
    /// The most files that may be written.
    pub max_files: u64,
    /// Only tiles that meet this rectangle are exported, with those above them; `None` exports all.
    pub bounds: Option<DegreeBounds>,
    /// Heights: [`FeatureCoordinates::Wgs84`] transforms them to the ellipsoid,
    /// [`FeatureCoordinates::Wgs84WithPackageHeights`] keeps them as they are.
    pub coordinates: FeatureCoordinates,
    /// The place where the availability of tiles is stored.
    pub availability: Availability,
    /// Whether files are compressed with gzip; a server must then declare this for each file.
    pub gzip: bool,
    /// The number of tiles that are created concurrently.
    pub threads: usize,
}

/// The place where the availability of tiles is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Availability {
    /// Availability is stored in layer.json, as rectangles of tiles.
    Layer,
    /// Availability is stored in the tiles of every tenth level, for the tiles beneath: layer.json
    /// stays small with any number of tiles.
    Tiles,
}

/// The plan of an export of terrain tiles.
#[derive(Debug, Clone)]
pub struct QuantizedMeshPlan {
    /// Each level, coarsest first.
    pub levels: Vec<MeshLevelPlan>,
    /// Bytes of all files, estimated from a sample of tiles.
    pub bytes: u64,
    /// The tiles of the finest level.
    pub(crate) candidates: BTreeSet<TerrainTile>,
}

/// The plan of a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshLevelPlan {
    /// The level.
    pub level: u8,
    /// The most tiles that it can have; tiles without ground are skipped.
    pub tiles: u64,
    /// The time for one tile, relative to a tile of the finest level.
    pub effort: f64,
}

/// The figures of an export of terrain tiles.
#[derive(Debug, Clone, PartialEq)]
pub struct QuantizedMeshSummary {
    /// Each level, coarsest first.
    pub levels: Vec<QuantizedMeshLevel>,
    /// What heights refer to, in words.
    pub heights: String,
}

/// The figures of a level.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct QuantizedMeshLevel {
    /// The level.
    pub level: u8,
    /// The number of tiles.
    pub tiles: u64,
    /// The number of triangles.
    pub triangles: u64,
    /// Bytes of the files.
    pub bytes: u64,
    /// Cells along the sides of the rasters on which the ground was sampled.
    pub cells: u64,
    /// The error that CesiumJS assumes for the level, metres.
    pub assumed_error_m: f64,
    /// Places with ground at which the tiles were measured.
    pub places: u64,
    /// Largest vertical distance of a tile from the package's finest ground there, metres.
    pub deviation_m: f64,
    /// Root of the mean square of these distances.
    pub deviation_rms_m: f64,
}
