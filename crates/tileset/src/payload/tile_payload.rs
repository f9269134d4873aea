//! A decoded tile: its ground, its roads for both methods, and the attributes of their ways.

use corniche_drape::{DrapedLine, SvLine};
use corniche_geom::TileId;
use corniche_roads::{FunctionalRoadClass, RoadAttributes};
use corniche_tin::Tin;

use crate::payload::relief::Relief;

/// The decoded content of a tile, except the parts that are read separately: its photo
/// ([`decode_photo`](crate::decode_photo)), areas, lines and spans. Sections that are absent from
/// the bytes are empty or `None` here.
#[derive(Debug, Clone, PartialEq)]
pub struct TilePayload {
    /// The tile.
    pub id: TileId,
    /// The ground of the tile; `None` for a tile without ground.
    pub terrain: Option<TileTerrain>,
    /// The raster of its level, for shading; `None` in packages without relief.
    pub relief: Option<Relief>,
    /// Centre-lines on the TIN (GEO roads), sorted by class, way id, part.
    pub roads_geo: Vec<GeoRoad>,
    /// Lines in plan for shadow volumes (SV roads), sorted by class, way id, part.
    pub roads_sv: Vec<SvRoad>,
    /// The attributes of each way that occurs in this tile, sorted by way id.
    pub attributes: Vec<RoadRecord>,
}

/// The ground of a tile.
#[derive(Debug, Clone, PartialEq)]
pub struct TileTerrain {
    /// The triangles.
    pub tin: Tin,
    /// Unit normal of the DEM at each vertex, octahedron-coded (Meyer et al. 2010, *On
    /// Floating-Point Normal Vectors*), in steps of 1/127.
    pub normals: Vec<[i8; 2]>,
    /// Error in metres of drawing this tile instead of the full-resolution DEM; never below that of
    /// its children.
    pub geometric_error_m: f64,
    /// Heights in metres of the lowest and the highest full-resolution node beneath the tile.
    pub height_range_m: [f64; 2],
    /// Full-resolution nodes with data beneath the tile that the TIN does not cover (next to voids
    /// and data edges).
    pub uncovered_nodes: u64,
}

/// The summary of the ground of a tile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TerrainSummary {
    /// See [`TileTerrain::geometric_error_m`].
    pub geometric_error_m: f64,
    /// See [`TileTerrain::height_range_m`].
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

/// The attributes of a way.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RoadRecord {
    /// OSM's id of the way.
    pub way_id: i64,
    /// The attributes from its tags.
    pub attributes: RoadAttributes,
}
