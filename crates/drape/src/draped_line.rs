//! The lines of tiles: draped on the TIN for GEO, or in plan with a range of heights for SV. (GEO
//! roads are drawn as geometry on the TIN, SV roads by shadow volumes.)

use corniche_geom::LatticePoint;

/// A vertex of a [`DrapedLine`] by its definition; its position and height follow from the TIN.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DrapedVertex {
    /// A point of the source line (or of its cut at the tile border) in `triangle` or on its
    /// border.
    Source {
        /// The point.
        point: LatticePoint,
        /// A triangle that contains the point; the height comes from this triangle's plane.
        triangle: u32,
    },
    /// The point where the line crosses the interior of the edge between the TIN vertices `a` <
    /// `b`.
    Crossing {
        /// The end with the smaller index.
        a: u32,
        /// The end with the larger index.
        b: u32,
    },
    /// The point where the line passes through a TIN vertex that is not a point of the source line.
    Vertex {
        /// The TIN vertex.
        vertex: u32,
    },
}

/// A centre-line draped on the TIN of one tile: every edge between neighbouring vertices is in one
/// triangle.
///
/// Crossings store the edge, not a position: the position is computed in f64 from the edge and from
/// the segment between the nearest source points before and after. A line that enters from a place
/// without ground begins with a crossing or a TIN vertex, and a line that leaves to a place without
/// ground ends with one. `lead_in` (or `lead_out`) is then the source point outside, which
/// determines the segment's direction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DrapedLine {
    /// The source point before the first vertex, if that vertex is not itself a source point.
    pub lead_in: Option<LatticePoint>,
    /// At least two vertices.
    pub vertices: Vec<DrapedVertex>,
    /// The source point after the last vertex, if that vertex is not itself a source point.
    pub lead_out: Option<LatticePoint>,
}

/// A centre-line for shadow volumes: the line in plan near one tile, and the height range of the
/// ground along it.
#[derive(Debug, Clone, PartialEq)]
pub struct SvLine {
    /// Points in plan: at least two; neighbouring points differ.
    pub points: Vec<LatticePoint>,
    /// For each segment the lowest and the highest ground of this tile within the margin around it,
    /// in metres.
    pub ground_range_m: Vec<[f64; 2]>,
}
