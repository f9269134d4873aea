//! An area of a layer: its object, its class and values, and its polygons.

use std::collections::BTreeMap;

use corniche_areas::Coastline;
use corniche_areas::Polygon;
use corniche_layers::{AttributeValue, OsmObject};

use crate::AreaLoss;

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

/// The areas of an extract, and what became of them. In numbers: `objects = kept + lost`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AreaSummary {
    /// Ways and relations with tags of the layer.
    pub objects: u64,
    /// Delivered areas, by the number of their class.
    pub kept: BTreeMap<u8, KeptAreas>,
    /// Objects that did not become areas, by reason.
    pub lost: BTreeMap<AreaLoss, u64>,
    /// Values that are not of the kinds of their attributes, by key.
    pub unread: BTreeMap<String, u64>,
    /// Coastlines on the package's lattice, if the table includes the sea. They do not count as
    /// objects.
    pub coastlines: Vec<Coastline>,
}

/// Areas of one class.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct KeptAreas {
    /// The number of areas.
    pub areas: u64,
    /// The number of their polygons.
    pub polygons: u64,
    /// The number of points in all rings.
    pub points: u64,
    /// The true area of the objects, square metres. Overlapping areas all count.
    pub area_m2: f64,
}
