//! What a user asks for when a package becomes quantized-mesh terrain tiles.

use super::tiling::Tiling;
use crate::{bounds::DegreeBounds, feature_request::Coordinates};

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
