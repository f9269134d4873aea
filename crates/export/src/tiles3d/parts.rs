//! The primitives of a tile, ready to be written.

use corniche_geom::TileId;
use corniche_roads::FunctionalRoadClass;

use crate::{relief_map::ReliefMap, surfaces::SurfaceKind};

/// A list of vertices with one material, in glTF's axes: y upwards.
#[derive(Default)]
pub(crate) struct Primitive {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) normals: Vec<[f32; 3]>,
    /// Linear red, green and blue, and 255; empty with an image.
    pub(crate) colors: Vec<[u8; 4]>,
    /// Texture coordinates on the tile's image; empty without one, and for roads.
    pub(crate) picture_places: Vec<[f32; 2]>,
    /// Texture coordinates on the tile's relief, and tangents with the handedness 1; empty without
    /// one, and for roads.
    pub(crate) relief_places: Vec<[f32; 2]>,
    pub(crate) tangents: Vec<[f32; 4]>,
    /// The ways of the vertices of roads.
    pub(crate) ways: Vec<i64>,
    /// Three per triangle, two per line; strips are separated by [`RESTART`].
    pub(crate) indices: Vec<u32>,
}

/// The index that ends a strip of lines.
pub(crate) const RESTART: u32 = u32::MAX;

/// The kind of a primitive.
#[derive(Clone, Copy)]
pub(crate) enum PrimitiveKind {
    /// Triangles; a slab contains all surfaces of a bridge except that of the road.
    Surface(SurfaceKind),
    Skirt,
    RoadLines(FunctionalRoadClass),
    RoadStrips(FunctionalRoadClass),
}

impl PrimitiveKind {
    /// The class of roads.
    pub(crate) fn class(self) -> Option<FunctionalRoadClass> {
        match self {
            Self::Surface(kind) => kind.class(),
            Self::Skirt => None,
            Self::RoadLines(class) | Self::RoadStrips(class) => Some(class),
        }
    }

    pub(crate) fn name(self) -> String {
        match self {
            Self::Surface(kind) => kind.name(),
            Self::Skirt => "skirt".to_owned(),
            Self::RoadLines(class) | Self::RoadStrips(class) => SurfaceKind::Road(class).name(),
        }
    }
}

/// A row of the table of roads.
pub(crate) struct RoadRow {
    pub(crate) way_id: i64,
    pub(crate) class: u8,
    /// Name, reference, `highway`, and bridge or tunnel.
    pub(crate) texts: [String; 4],
}

/// The content of a tile of glTF.
pub(crate) struct TileContent {
    pub(crate) id: TileId,
    /// The translation of the node, y upwards.
    pub(crate) translation: [f64; 3],
    pub(crate) parts: Vec<(PrimitiveKind, Primitive)>,
    pub(crate) roads: Vec<RoadRow>,
    /// The image of the ground as JPEG.
    pub(crate) picture: Option<Vec<u8>>,
    /// The normal map of the ground.
    pub(crate) relief: Option<ReliefMap>,
}
