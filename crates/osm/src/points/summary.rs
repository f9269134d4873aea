//! Counts of the objects of a layer of points: found, kept and lost.

use std::collections::BTreeMap;

use crate::AreaLoss;

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
