//! What a user asks for when a package becomes 3D Tiles.

use corniche_roads::FunctionalRoadClass;
use corniche_styles::Style;

use crate::{bounds::DegreeBounds, feature_request::Coordinates};

/// What tiles have of roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TileRoads {
    /// Surfaces of their true width, cut into the ground's own triangles.
    Cut,
    /// Roads are there as their centre-lines, lifted a little above the ground.
    Line,
    /// The same as vector content, in a second tileset (`3DTILES_content_gltf_vector`, a draft).
    Vector,
    /// Roads are left out.
    None,
}

/// What of a package becomes 3D Tiles, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Tiles3dRequest {
    /// The finest level that is taken; `None` is the package's finest.
    pub finest_level: Option<u8>,
    /// Tiles that meet it are taken, whole; `None` takes all.
    pub bounds: Option<DegreeBounds>,
    /// How roads are there.
    pub roads: TileRoads,
    /// The classes of roads that are taken.
    pub classes: Vec<FunctionalRoadClass>,
    /// Widths and colours of roads, and colours of the ground.
    pub style: Style,
    /// Whether the package's reliefs become normal maps.
    pub relief: bool,
    /// Whether walls hang from the borders of tiles, which hide gaps between levels.
    pub skirts: bool,
    /// Whether vertices and indices are compressed (`EXT_meshopt_compression`).
    pub compress: bool,
    /// Heights: [`Coordinates::Wgs84`] carries them to the ellipsoid, [`Coordinates::Wgs84WithPackageHeights`] takes them as they are.
    pub coordinates: Coordinates,
    /// How many tiles are made at the same time.
    pub threads: usize,
}
