//! An object of a layer in a tile: its class, its attributes and its shape inside the tile.

use corniche_geom::LatticePoint;
use corniche_layers::{AttributeKind, AttributeValue, LayerForm, LayerGeometry, OsmObject};
use serde::{Deserialize, Serialize};

/// An object of a layer, or the part of it that is in a tile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LayerObject {
    /// The number of its class in the layer's table.
    pub class: u8,
    /// The OSM object.
    pub object: OsmObject,
    /// The values of the layer's attributes, in the order of the table.
    pub values: Vec<Option<AttributeValue>>,
    /// Its points.
    pub shape: LayerShape,
}

/// The points of an object of a layer, on the package's lattice.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum LayerShape {
    /// Successive segments of a line, each of which enters the tile or the margin of its level
    /// around it. Segments are not cut at the border. At least two points; neighbouring points are
    /// different.
    Line(Vec<LatticePoint>),
    /// The parts of an area in the tile; at least one.
    Area(Vec<AreaPolygon>),
    /// A point in the tile.
    Point(LatticePoint),
}

/// A polygon: an outer ring, counter-clockwise, then rings around its holes, clockwise. The first
/// point of a ring is not repeated at its end. All points are in the tile or on its border.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AreaPolygon {
    /// At least one ring, each of at least three points.
    pub rings: Vec<Vec<LatticePoint>>,
}

/// How a layer's objects are encoded, which its table decides.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LayerCoding {
    /// The geometry of all objects.
    pub geometry: LayerGeometry,
    /// The number of classes.
    pub classes: usize,
    /// The kinds of the attributes, in the order of the table.
    pub attributes: Vec<AttributeKind>,
}

impl LayerCoding {
    /// Returns the coding of a layer with this table.
    #[must_use]
    pub fn from_table(table: &LayerForm) -> Self {
        Self {
            geometry: table.geometry,
            classes: table.classes.len(),
            attributes: table.attributes.values().copied().collect(),
        }
    }
}

impl LayerShape {
    /// Iterates over all points of the object.
    pub fn points(&self) -> impl Iterator<Item = &LatticePoint> {
        let (polygons, points) = match self {
            Self::Line(points) => (&[][..], points.as_slice()),
            Self::Area(polygons) => (polygons.as_slice(), &[][..]),
            Self::Point(point) => (&[][..], std::slice::from_ref(point)),
        };
        polygons.iter().flat_map(|polygon| &polygon.rings).flatten().chain(points)
    }

    /// Iterates over the rings of an area.
    pub fn rings(&self) -> impl Iterator<Item = &Vec<LatticePoint>> {
        let polygons = if let Self::Area(polygons) = self { polygons.as_slice() } else { &[] };
        polygons.iter().flat_map(|polygon| &polygon.rings)
    }
}
