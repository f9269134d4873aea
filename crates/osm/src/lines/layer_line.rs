//! A part of a way of a layer of lines, with its class, its values and its points.

use std::collections::BTreeMap;

use corniche_geom::LatticePoint;
use corniche_layers::AttributeValue;
use corniche_roads::Structure;

use crate::losses::LineLoss;

/// A part of a way of a layer of lines.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerLine {
    /// OSM's id of the way.
    pub way_id: i64,
    /// The structure that carries the way, if lines of the layer may be on bridges and in tunnels;
    /// otherwise the ground.
    pub structure: Structure,
    /// The number of the first of the classes that objects give the way.
    pub class: u8,
    /// The values of the layer's attributes, in the table's order: those of the object that gives
    /// the class. The way itself comes before relations, and a relation with a lower id before
    /// others.
    pub values: Vec<Option<AttributeValue>>,
    /// The points on the package's lattice, at least two; neighbours differ. A way has several
    /// parts if points between them have no position.
    pub points: Vec<LatticePoint>,
    /// The indices of the points that simplification must keep: the ends, and every node that
    /// another line shares. Ascending.
    pub fixed: Vec<u32>,
}

/// The ways of a layer of lines, and what became of them. In numbers: `ways = kept + lost`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LineSummary {
    /// Ways and relations with the tags of a class.
    pub objects: u64,
    /// Ways that have a class; each counts once.
    pub ways: u64,
    /// Delivered ways, by the number of their class.
    pub kept: BTreeMap<u8, u64>,
    /// Skipped ways, by reason.
    pub lost: BTreeMap<LineLoss, u64>,
    /// Values that are not of the kinds of their attributes, by key.
    pub unread: BTreeMap<String, u64>,
}
