//! An area of a layer: its object, its class and values, and its polygons.

use corniche_areas::Polygon;
use corniche_layers::{AttributeValue, OsmObject};

/// An area of a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerArea {
    /// The closed way, or the relation of the type `multipolygon` or `boundary`.
    pub object: OsmObject,
    /// The number of its class.
    pub class: u8,
    /// The values of the layer's attributes, in the table's order.
    pub values: Vec<Option<AttributeValue>>,
    /// The parts of the area, at least one.
    pub polygons: Vec<Polygon>,
    /// The true area on the ellipsoid, square metres.
    pub area_m2: f64,
}
