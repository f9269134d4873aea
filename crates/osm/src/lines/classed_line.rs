//! A part of a way of a boundary, with its class and its points.

use corniche_areas::BoundaryClass;
use corniche_geom::LatticePoint;

/// A part of a way of a boundary.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ClassedLine {
    /// OSM's id of the way.
    pub way_id: i64,
    /// The most important of the classes that objects give the way.
    pub class: BoundaryClass,
    /// The points on the package's lattice, at least two; neighbours differ. A way has several
    /// parts if points between them have no position.
    pub points: Vec<LatticePoint>,
    /// The indices of the points that simplification must keep: the ends, and every node that
    /// another line shares. Ascending.
    pub fixed: Vec<u32>,
}
