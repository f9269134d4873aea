//! A part of a way of a layer of lines, with its class and its points.

use corniche_areas::LineClass;
use corniche_geom::LatticePoint;

/// A part of a way of a layer of lines.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ClassedLine {
    /// OSM's id of the way.
    pub way_id: i64,
    /// The most important of the classes that objects give it.
    pub class: LineClass,
    /// Its points on the package's lattice, two at least; neighbours are different. A way comes in several parts where points in between
    /// have no place.
    pub points: Vec<LatticePoint>,
    /// Indices of the points that no simplification may remove: the ends, and every node that another line of the layer shares. Ascending.
    pub fixed: Vec<u32>,
}
