//! A point of a layer: its object, its class and values, and its place.

use corniche_geom::LatticePoint;
use corniche_layers::{AttributeValue, OsmObject};

/// A point of a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerPoint {
    /// The node, the closed way, or the relation of the type `multipolygon` or `boundary`.
    pub object: OsmObject,
    /// The number of its class.
    pub class: u8,
    /// The values of the layer's attributes, in the table's order.
    pub values: Vec<Option<AttributeValue>>,
    /// The place of the node, or a place inside the outline, on the package's lattice.
    pub at: LatticePoint,
}
