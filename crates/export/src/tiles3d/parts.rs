//! What a tile is made of, ready to be written.

use corniche_roads::FunctionalRoadClass;
use corniche_styles::Rgb;

use crate::{gltf::SLAB_NAME, relief_map::ReliefMap};

/// A list of vertices of one material, as glTF has it: y upwards.
#[derive(Clone, Default)]
pub(crate) struct Primitive {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) normals: Vec<[f32; 3]>,
    /// Linear red, green and blue, and 255; empty with a picture.
    pub(crate) colors: Vec<[u8; 4]>,
    /// Where on the tile's picture; empty without one, and for roads.
    pub(crate) picture_places: Vec<[f32; 2]>,
    /// Where on the tile's relief, and the tangents that it is read with, sides told by 1; empty without one, and for roads.
    pub(crate) relief_places: Vec<[f32; 2]>,
    pub(crate) tangents: Vec<[f32; 4]>,
    /// The ways of the vertices of roads.
    pub(crate) ways: Vec<i64>,
    /// Three to a triangle, two to a line; strips with [`RESTART`] between them.
    pub(crate) indices: Vec<u32>,
}

/// Ends a strip of lines, among indices.
pub(crate) const RESTART: u32 = u32::MAX;

/// What a part is.
#[derive(Clone, Copy)]
pub(crate) enum PrimitiveKind {
    Terrain,
    Skirt,
    RoadSurfaces(FunctionalRoadClass),
    /// What slabs of bridges have beside the surface of the road.
    BridgeSlabs(FunctionalRoadClass),
    RoadLines(FunctionalRoadClass),
    RoadStrips(FunctionalRoadClass),
}

impl PrimitiveKind {
    /// The class of roads.
    pub(crate) fn class(self) -> Option<FunctionalRoadClass> {
        match self {
            Self::Terrain | Self::Skirt => None,
            Self::RoadSurfaces(class)
            | Self::BridgeSlabs(class)
            | Self::RoadLines(class)
            | Self::RoadStrips(class) => Some(class),
        }
    }

    pub(crate) fn name(self) -> String {
        match self {
            Self::Terrain => "terrain".to_owned(),
            Self::Skirt => "skirt".to_owned(),
            Self::BridgeSlabs(_) => SLAB_NAME.to_owned(),
            Self::RoadSurfaces(class) | Self::RoadLines(class) | Self::RoadStrips(class) => {
                format!("roads FRC {}", class.number())
            }
        }
    }
}

/// A row of the table of roads.
#[derive(Clone)]
pub(crate) struct RoadRow {
    pub(crate) way_id: i64,
    pub(crate) class: u8,
    /// Name, reference, `highway`, and bridge or tunnel.
    pub(crate) texts: [String; 4],
}

/// A tile of glTF.
#[derive(Clone)]
pub(crate) struct TileContent {
    pub(crate) name: String,
    /// The translation of the node, y upwards.
    pub(crate) translation: [f64; 3],
    pub(crate) parts: Vec<(PrimitiveKind, Primitive)>,
    pub(crate) roads: Vec<RoadRow>,
    /// Colours of roads by class.
    pub(crate) colors: [Rgb; FunctionalRoadClass::COUNT],
    /// JPEG of the ground.
    pub(crate) picture: Option<Vec<u8>>,
    /// Normal map of the ground.
    pub(crate) relief: Option<ReliefMap>,
    pub(crate) copyright: String,
    pub(crate) generator: String,
}
