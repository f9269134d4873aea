//! A TIN placed on the lattice, with its adjacency and a spatial index. (contract; being filled in)

use corniche_geom::{LatticeBounds, LatticePoint};

use crate::Tin;

/// Marks a half-edge without a neighbour in [`Surface::twin`]'s table: it lies on the outline of the ground.
pub const NO_TWIN: u32 = u32::MAX;

/// Where a tile's TIN lies on the lattice and how high its steps are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Lattice point of node column 0, row 0: the north-west corner.
    pub corner: LatticePoint,
    /// Lattice steps from one node to the next.
    pub node_steps: i64,
    /// Height of one step of `height_q`, metres; a power of two, so heights in f64 are exact.
    pub quantum_m: f64,
}

/// A TIN with positions on the lattice, twins of its half-edges and a grid of buckets to find triangles.
#[derive(Debug, Clone)]
pub struct Surface {
    points: Vec<LatticePoint>,
    heights_m: Vec<f64>,
    triangles: Vec<[u32; 3]>,
    twins: Vec<u32>,
}

impl Surface {
    /// Places `tin` on the lattice.
    #[must_use]
    pub fn new(tin: &Tin, placement: Placement) -> Self {
        let _ = (tin, placement);
        todo!()
    }
    /// Lattice points of the vertices, as indexed by the TIN.
    #[must_use]
    pub fn points(&self) -> &[LatticePoint] {
        &self.points
    }
    /// Heights of the vertices.
    #[must_use]
    pub fn heights_m(&self) -> &[f64] {
        &self.heights_m
    }
    /// Triangles as in the TIN.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }
    /// The half-edge on the other side of half-edge `3 · triangle + k` (from corner k to corner k + 1);
    /// [`NO_TWIN`] on the outline of the ground.
    #[must_use]
    pub fn twin(&self, half_edge: u32) -> u32 {
        self.twins[half_edge as usize]
    }
    /// The triangle with the smallest index that holds `point`, borders included; `None` off the ground.
    #[must_use]
    pub fn locate(&self, point: LatticePoint) -> Option<u32> {
        let _ = point;
        todo!()
    }
    /// Height of the plane of `triangle` above a position in (fractional) lattice steps.
    #[must_use]
    pub fn height_in_triangle_m(&self, triangle: u32, at: [f64; 2]) -> f64 {
        let _ = (triangle, at);
        todo!()
    }
    /// All triangles whose bounding boxes meet `bounds`, in ascending order, without repetition.
    pub fn triangles_near(&self, bounds: LatticeBounds, out: &mut Vec<u32>) {
        let _ = (bounds, out);
        todo!()
    }
}
