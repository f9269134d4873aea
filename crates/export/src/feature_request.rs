//! What a user asks for when roads or areas become features of a vector file.

use corniche_areas::AreaClass;
use corniche_roads::FunctionalRoadClass;

use crate::{bounds::DegreeBounds, vector::VectorFormat};

/// What coordinates the features get.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coordinates {
    /// Coordinates of the package's CRS, with the package's heights: exactly what the tiles hold.
    Package,
    /// Longitude, latitude and height above the ellipsoid of WGS84 (EPSG:4979).
    Wgs84,
    /// Longitude and latitude of WGS84, with the package's heights as they are.
    Wgs84WithPackageHeights,
}

/// Which areas of a package are exported, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct AreasRequest {
    /// The format of the file.
    pub format: VectorFormat,
    /// The level whose areas are taken; `None` is the finest.
    pub level: Option<u8>,
    /// The classes that are taken.
    pub classes: Vec<AreaClass>,
    /// The coordinates of features; areas have no heights.
    pub coordinates: Coordinates,
    /// Memory for sorting, bytes.
    pub memory_bytes: u64,
}

/// Which roads of a package are exported, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct RoadsRequest {
    /// The format of the file.
    pub format: VectorFormat,
    /// The level whose roads are taken; `None` is the finest.
    pub level: Option<u8>,
    /// The classes that are taken.
    pub classes: Vec<FunctionalRoadClass>,
    /// Roads are cut here.
    pub bounds: Option<DegreeBounds>,
    /// A feature for each piece, as the tiles have them, in place of one for each way.
    pub pieces: bool,
    /// The coordinates of features.
    pub coordinates: Coordinates,
    /// Memory for sorting, bytes.
    pub memory_bytes: u64,
}
