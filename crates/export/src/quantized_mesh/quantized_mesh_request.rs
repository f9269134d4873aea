//! What a user asks for when a package becomes quantized-mesh terrain tiles, what will be written,
//! and what was.

use std::collections::BTreeSet;

use super::tiling::{TerrainTile, Tiling};
use crate::{bounds::DegreeBounds, places::Coordinates};

/// What of a package becomes terrain tiles, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct QuantizedMeshRequest {
    /// The grid of tiles.
    pub tiling: Tiling,
    /// The finest level; `None` is the first one whose error is not above the package's, or whose cells are the package's.
    pub max_level: Option<u8>,
    /// The most files that may be written.
    pub max_files: u64,
    /// Only tiles that meet these degrees, and those above them; `None` takes all.
    pub bounds: Option<DegreeBounds>,
    /// Heights: [`Coordinates::Wgs84`] carries them to the ellipsoid, [`Coordinates::Wgs84WithPackageHeights`] takes them as they are.
    pub coordinates: Coordinates,
    /// Where it is told which tiles there are.
    pub availability: Availability,
    /// Whether files are compressed with gzip; a server must then say so for each.
    pub gzip: bool,
    /// How many tiles are made at the same time.
    pub threads: usize,
}

/// Where it is told which tiles there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Availability {
    /// It is told in layer.json, as rectangles of tiles.
    Layer,
    /// It is told in tiles of each tenth level, for those beneath: layer.json stays small with any number of tiles.
    Tiles,
}

/// What an export of terrain tiles will write.
#[derive(Debug, Clone)]
pub struct QuantizedMeshPlan {
    /// Each level, coarsest first.
    pub levels: Vec<PlannedLevel>,
    /// Bytes of all files, estimated from some tiles.
    pub bytes: u64,
    /// The tiles of the finest level.
    pub(crate) candidates: BTreeSet<TerrainTile>,
}

/// What will be written of a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedLevel {
    /// The level.
    pub level: u8,
    /// The most tiles that it can have: those without ground are left out.
    pub tiles: u64,
    /// How long one takes, in those of the finest level.
    pub effort: f64,
}

/// What was exported.
#[derive(Debug, Clone, PartialEq)]
pub struct QuantizedMeshSummary {
    /// Each level, coarsest first.
    pub levels: Vec<QuantizedMeshLevel>,
    /// What heights are, in words.
    pub heights: String,
}

/// What was exported of a level.
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
    /// What CesiumJS takes the level's error to be, metres.
    pub assumed_error_m: f64,
    /// Places with ground at which the tiles were measured.
    pub places: u64,
    /// Largest vertical distance of a tile from the package's finest ground there, metres.
    pub deviation_m: f64,
    /// Root of the mean square of these distances.
    pub deviation_rms_m: f64,
}
