//! A part of a way that is a boundary, with its class and its points.

use corniche_areas::BoundaryClass;
use corniche_geom::LatticePoint;

/// A part of a way that is a boundary.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Boundary {
    /// OSM's id of the way.
    pub way_id: i64,
    /// The most important of what it bounds.
    pub class: BoundaryClass,
    /// Its points on the package's lattice, two at least; neighbours are different. A way comes in several parts where points in between
    /// have no place.
    pub points: Vec<LatticePoint>,
    /// Indices of the points that no simplification may remove: the ends, and every node that another boundary shares. Ascending.
    pub fixed: Vec<u32>,
}
