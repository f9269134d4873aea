//! A point of a layer: its object, its class and values, and its place.

use std::collections::BTreeMap;

use corniche_geom::LatticePoint;
use corniche_layers::{AttributeValue, OsmObject};

use crate::AreaLoss;

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

/// The objects of a layer of points, and what became of them. In numbers: `objects = kept + lost`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct PointSummary {
    /// Nodes, ways and relations with tags of the layer.
    pub objects: u64,
    /// Delivered points, by the number of their class.
    pub kept: BTreeMap<u8, u64>,
    /// Objects that did not become points, by reason.
    pub lost: BTreeMap<AreaLoss, u64>,
    /// Values that are not of the kinds of their attributes, by key.
    pub unread: BTreeMap<String, u64>,
}
