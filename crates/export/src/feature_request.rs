//! What a user asks for when a layer becomes features of a vector file.

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
    /// Coordinates of a projected CRS of the EPSG registry, by its code, with the package's heights as they are.
    Epsg(u32),
}

/// Which objects of a layer of a package are exported, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct FeatureRequest<C> {
    /// The format of the file.
    pub format: VectorFormat,
    /// The level whose objects are taken; `None` is the finest.
    pub level: Option<u8>,
    /// The classes that are taken.
    pub classes: Vec<C>,
    /// Objects are cut here.
    pub bounds: Option<DegreeBounds>,
    /// The coordinates of features; only roads have heights.
    pub coordinates: Coordinates,
    /// Memory for sorting, bytes.
    pub memory_bytes: u64,
}

/// Which features roads become.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RoadFeatures {
    /// One for each way.
    Ways,
    /// One for each piece, as the tiles have them.
    Pieces,
}
