//! Lines as tiles hold them: laid on the TIN for GEO, or in plan with a range of heights for SV.

use corniche_geom::LatticePoint;

/// A vertex of a [`DrapedLine`], by what defines it; positions and heights follow from the TIN.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DrapedVertex {
    /// A point of the source line (or its cut at the tile border) in `triangle`, its border included.
    Source {
        /// The point.
        point: LatticePoint,
        /// A triangle that holds it; its height is taken from this triangle's plane.
        triangle: u32,
    },
    /// Where the line crosses the inside of the edge between TIN vertices `a` < `b`.
    Crossing {
        /// The end with the smaller index.
        a: u32,
        /// The end with the larger index.
        b: u32,
    },
    /// Where the line passes through a TIN vertex that is no point of the source line.
    Vertex {
        /// The TIN vertex.
        vertex: u32,
    },
}

/// A centre-line laid on the TIN of one tile: every edge between neighbouring vertices lies in one triangle.
///
/// Crossings store the edge, not a position: it is recomputed in f64 from the edge and from the segment between the
/// nearest source points before and after. A line that comes from a place without ground begins with a crossing or a
/// TIN vertex, and one that goes to such a place ends with one; `lead_in` (`lead_out`) is then the source point
/// outside that fixes the segment's direction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DrapedLine {
    /// The source point before the first vertex, when that vertex is not itself a source point.
    pub lead_in: Option<LatticePoint>,
    /// At least two vertices.
    pub vertices: Vec<DrapedVertex>,
    /// The source point after the last vertex, when that vertex is not itself a source point.
    pub lead_out: Option<LatticePoint>,
}

/// A centre-line for shadow volumes: the plan line near one tile and how high its ground is along it.
#[derive(Debug, Clone, PartialEq)]
pub struct SvLine {
    /// Points in plan; at least two, no two neighbours equal.
    pub points: Vec<LatticePoint>,
    /// Per segment the lowest and highest ground of this tile within the margin around it, metres.
    pub ground_range_m: Vec<[f64; 2]>,
}
