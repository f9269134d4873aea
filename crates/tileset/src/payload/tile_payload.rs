//! A decoded tile: its ground, its roads for both methods, and what is known of their ways.

use corniche_drape::{DrapedLine, SvLine};
use corniche_geom::TileId;
use corniche_roads::{FunctionalRoadClass, RoadAttributes};
use corniche_tin::Tin;

use crate::payload::relief::Relief;

/// All that a tile holds, decoded, but for what is read by itself: its photo ([`decode_photo`](crate::decode_photo)), areas, lines and spans. A section
/// that is absent from the bytes is empty or `None` here.
#[derive(Debug, Clone, PartialEq)]
pub struct TilePayload {
    /// The tile.
    pub id: TileId,
    /// Its ground; `None` for a tile without any.
    pub terrain: Option<Terrain>,
    /// The raster of its level, for shading; `None` in packages without.
    pub relief: Option<Relief>,
    /// Centre-lines on the TIN, sorted by class, way id, part.
    pub roads_geo: Vec<GeoRoad>,
    /// Plan lines for shadow volumes, sorted by class, way id, part.
    pub roads_sv: Vec<SvRoad>,
    /// What is known of each way that occurs in this tile, sorted by way id.
    pub attributes: Vec<RoadRecord>,
}

/// The ground of a tile.
#[derive(Debug, Clone, PartialEq)]
pub struct Terrain {
    /// The triangles.
    pub tin: Tin,
    /// Unit normal of the DEM at each vertex, octahedron-coded (Meyer et al. 2010, *On Floating-Point Normal
    /// Vectors*), in steps of 1/127.
    pub normals: Vec<[i8; 2]>,
    /// Error of drawing this tile instead of the full-resolution DEM; never below its children's.
    pub geometric_error_m: f64,
    /// Heights of the lowest and the highest full-resolution node beneath the tile.
    pub height_range_m: [f64; 2],
    /// Full-resolution nodes with data beneath that the TIN does not cover (next to voids and data edges).
    pub uncovered_nodes: u64,
}

/// What the ground of a tile states about itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TerrainSummary {
    /// See [`Terrain::geometric_error_m`].
    pub geometric_error_m: f64,
    /// See [`Terrain::height_range_m`].
    pub height_range_m: [f64; 2],
}

/// A road in a tile's GEO section.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GeoRoad {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Number of this piece along the way within the tile, from 0.
    pub part: u32,
    /// Functional road class.
    pub class: FunctionalRoadClass,
    /// The line.
    pub line: DrapedLine,
}

/// A road in a tile's SV section.
#[derive(Debug, Clone, PartialEq)]
pub struct SvRoad {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Number of this piece along the way within the tile, from 0.
    pub part: u32,
    /// Functional road class.
    pub class: FunctionalRoadClass,
    /// The line.
    pub line: SvLine,
}

/// What is known of a way.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RoadRecord {
    /// OSM's id of the way.
    pub way_id: i64,
    /// What its tags say.
    pub attributes: RoadAttributes,
}
