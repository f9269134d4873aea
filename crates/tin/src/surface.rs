//! A TIN placed on the lattice, with its adjacency and a spatial index.

mod buckets;

use corniche_geom::{GridFrame, IndexLists, LatticeBounds, LatticePoint, TileId, cross};

use crate::Tin;
use buckets::Buckets;

/// Marks a half-edge without a neighbour in [`Surface::twin`]'s table: it is on the boundary of the
/// ground.
pub const NO_TWIN: u32 = u32::MAX;

/// The position of a tile's TIN on the lattice, and the height of its steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// The lattice point of node column 0, row 0: the north-west corner.
    pub corner: LatticePoint,
    /// Number of lattice steps from one node to the next, east and north.
    pub node_steps: [i64; 2],
    /// The height of one step of `height_q` in metres; a power of two, so heights in f64 are exact.
    pub quantum_m: f64,
}

impl Placement {
    /// Returns the placement of the TIN of tile `id`, with heights in steps of `quantum_m`.
    ///
    /// # Panics
    /// When the tile's level is beyond the frame's finest level.
    #[must_use]
    pub fn of_tile(frame: &GridFrame, id: TileId, quantum_m: f64) -> Self {
        Self {
            corner: frame.lattice_of_node(frame.tile_corner(id)),
            node_steps: frame.node_steps(id.z()),
            quantum_m,
        }
    }
}

/// A TIN with positions on the lattice, twins of its half-edges and a grid of buckets to find
/// triangles.
///
/// Half-edge `3 · triangle + k` runs from corner k of the triangle to corner k + 1, its triangle on
/// its left:
///
/// ```text
///            corner 2
///             /    \
///    3t + 2  /      \  3t + 1        the half-edge on the other side of an edge is its twin;
///           v        \               where there is none, the edge is part of the boundary of the ground
///     corner 0 ──► corner 1
///             3t + 0
/// ```
#[derive(Debug, Clone)]
pub struct Surface {
    points: Vec<LatticePoint>,
    heights_m: Vec<f64>,
    triangles: Vec<[u32; 3]>,
    twins: Vec<u32>,
    /// The half-edges that start at each vertex.
    fans: IndexLists,
    /// Half-edges without a twin, ascending.
    boundary: Vec<u32>,
    triangle_buckets: Buckets,
    /// Buckets of indices into `boundary`.
    boundary_buckets: Buckets,
}

impl Surface {
    /// Places the TIN of tile `id`, with heights in steps of `quantum_m`.
    ///
    /// # Panics
    /// When the tile's level is beyond the frame's finest level.
    #[must_use]
    pub fn of_tile(tin: &Tin, frame: &GridFrame, id: TileId, quantum_m: f64) -> Self {
        Self::new(tin, Placement::of_tile(frame, id, quantum_m))
    }

    /// Places `tin` on the lattice.
    #[must_use]
    pub fn new(tin: &Tin, placement: Placement) -> Self {
        let Placement { corner, node_steps: [east, north], quantum_m } = placement;
        let points: Vec<LatticePoint> = tin
            .vertices()
            .iter()
            .map(|vertex| {
                let (column, row) = (i64::from(vertex.column), i64::from(vertex.row));
                LatticePoint::new(corner.u + column * east, corner.v - row * north)
            })
            .collect();
        let heights_m =
            tin.vertices().iter().map(|vertex| f64::from(vertex.height_q) * quantum_m).collect();
        let triangles = tin.triangles().to_vec();
        let corners = triangles.as_flattened();
        let fans = IndexLists::new(points.len(), corners.len(), |half_edge| {
            std::iter::once(corners[half_edge] as usize)
        });
        let mut surface = Self {
            points,
            heights_m,
            triangles,
            twins: Vec::new(),
            fans,
            boundary: Vec::new(),
            triangle_buckets: Buckets::default(),
            boundary_buckets: Buckets::default(),
        };
        surface.twins = vec![NO_TWIN; 3 * surface.triangles.len()];
        for half_edge in 0..surface.twins.len() {
            // Twins are mutual, so each pair is searched once.
            if surface.twins[half_edge] == NO_TWIN {
                let twin = surface.find_twin(half_edge as u32);
                surface.twins[half_edge] = twin;
                if let Some(of_twin) = surface.twins.get_mut(twin as usize) {
                    *of_twin = half_edge as u32;
                }
            }
        }
        surface.boundary = (0..surface.twins.len() as u32)
            .filter(|&h| surface.twins[h as usize] == NO_TWIN)
            .collect();
        let boxes: Vec<_> =
            surface.triangles.iter().map(|corners| surface.bounds_of(corners)).collect();
        surface.triangle_buckets = Buckets::new(&boxes);
        let boxes: Vec<_> =
            surface.boundary.iter().map(|&h| surface.bounds_of(&surface.ends(h))).collect();
        surface.boundary_buckets = Buckets::new(&boxes);
        surface
    }

    /// The lattice points of the vertices, with the indices of the TIN.
    #[must_use]
    pub fn points(&self) -> &[LatticePoint] {
        &self.points
    }

    /// The heights of the vertices in metres.
    #[must_use]
    pub fn heights_m(&self) -> &[f64] {
        &self.heights_m
    }

    /// The triangles of the TIN.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The half-edge on the other side of half-edge `3 · triangle + k` (from corner k to corner k +
    /// 1); [`NO_TWIN`] on the boundary of the ground.
    #[must_use]
    #[inline]
    pub fn twin(&self, half_edge: u32) -> u32 {
        self.twins[half_edge as usize]
    }

    /// The vertices at the start and at the end of a half-edge.
    #[must_use]
    #[inline]
    pub fn ends(&self, half_edge: u32) -> [u32; 2] {
        let corners = &self.triangles[half_edge as usize / 3];
        let k = half_edge as usize % 3;
        [corners[k], corners[(k + 1) % 3]]
    }

    /// The half-edges that start at `vertex`, ascending: one per triangle around it.
    #[must_use]
    pub fn fan(&self, vertex: u32) -> &[u32] {
        self.fans.list(vertex as usize)
    }

    /// The triangle with the smallest index that contains `point`, borders included; `None` off the
    /// ground.
    #[must_use]
    pub fn locate(&self, point: LatticePoint) -> Option<u32> {
        // A bucket lists its triangles in ascending order, and contains every triangle around
        // `point`.
        self.triangle_buckets
            .at(point)
            .iter()
            .copied()
            .find(|&triangle| self.triangle_holds(triangle, point))
    }

    /// Whether `point` is in `triangle`, its border included, exactly.
    #[must_use]
    pub fn triangle_holds(&self, triangle: u32, point: LatticePoint) -> bool {
        let [a, b, c] =
            self.triangles[triangle as usize].map(|vertex| self.points[vertex as usize]);
        cross(a, b, point) >= 0 && cross(b, c, point) >= 0 && cross(c, a, point) >= 0
    }

    /// The height of the plane of `triangle` above a position in (fractional) lattice steps.
    ///
    /// Exact at the triangle's corners. For positions beyond 2^53 steps, where f64 no longer
    /// represents whole steps, use [`Surface::height_at_point_m`].
    #[must_use]
    pub fn height_in_triangle_m(&self, triangle: u32, at: [f64; 2]) -> f64 {
        let a = self.points[self.triangles[triangle as usize][0] as usize];
        self.height_from_corner_m(triangle, [at[0] - a.u as f64, at[1] - a.v as f64])
    }

    /// The height of the plane of `triangle` above a lattice point; exact at the triangle's
    /// corners.
    #[must_use]
    pub fn height_at_point_m(&self, triangle: u32, point: LatticePoint) -> f64 {
        let a = self.points[self.triangles[triangle as usize][0] as usize];
        self.height_from_corner_m(triangle, [(point.u - a.u) as f64, (point.v - a.v) as f64])
    }

    /// The rise in metres of the plane of `triangle` per lattice step east and per lattice step
    /// north.
    #[must_use]
    pub fn gradient_m(&self, triangle: u32) -> [f64; 2] {
        let corners = self.triangles[triangle as usize].map(|vertex| vertex as usize);
        let [a, b, c] = corners.map(|vertex| self.points[vertex]);
        let [a_m, b_m, c_m] = corners.map(|vertex| self.heights_m[vertex]);
        let [b, c] = [b, c].map(|p| [(p.u - a.u) as f64, (p.v - a.v) as f64]);
        let (b_m, c_m) = (b_m - a_m, c_m - a_m);
        let doubled_area = b[0] * c[1] - c[0] * b[1];
        [(b_m * c[1] - c_m * b[1]) / doubled_area, (b[0] * c_m - c[0] * b_m) / doubled_area]
    }

    /// Finds all triangles whose bounding boxes meet `bounds`, in ascending order, without
    /// repetition; replaces the content of `out`.
    pub fn triangles_near(&self, bounds: LatticeBounds, out: &mut Vec<u32>) {
        self.triangle_buckets.near(bounds, out);
        out.retain(|&triangle| {
            self.bounds_of(&self.triangles[triangle as usize]).intersects(&bounds)
        });
    }

    /// Visits all triangles whose bounding boxes meet `bounds`, and perhaps others, perhaps more
    /// than once, in a fixed order: several times faster than [`Surface::triangles_near`], for
    /// callers that accept this.
    pub fn visit_triangles_near(&self, bounds: LatticeBounds, visit: impl FnMut(u32)) {
        self.triangle_buckets.visit(bounds, visit);
    }

    /// Finds all triangles that may be within `around` steps of a segment along each axis, and
    /// perhaps others, in ascending order, without repetition; replaces the content of `out`.
    /// `around` must be at least 1, for rounding.
    pub fn triangles_along(&self, ends: [[f64; 2]; 2], around: f64, out: &mut Vec<u32>) {
        out.clear();
        self.triangle_buckets.visit_along(ends, around, |triangle| out.push(triangle));
        out.sort_unstable();
        out.dedup();
    }

    /// Finds all half-edges without a twin whose bounding boxes meet `bounds`, in ascending order,
    /// without repetition; replaces the content of `out`.
    pub fn boundary_near(&self, bounds: LatticeBounds, out: &mut Vec<u32>) {
        self.boundary_buckets.near(bounds, out);
        for index in out.iter_mut() {
            *index = self.boundary[*index as usize];
        }
        out.retain(|&half_edge| self.bounds_of(&self.ends(half_edge)).intersects(&bounds));
    }

    /// The height at an offset, in lattice steps, from corner 0 of `triangle`.
    ///
    /// Offsets from a corner keep the products small wherever the tile is; at a corner the weights
    /// are exactly 0 and 1.
    fn height_from_corner_m(&self, triangle: u32, [du, dv]: [f64; 2]) -> f64 {
        let corners = self.triangles[triangle as usize];
        let [a, b, c] = corners.map(|vertex| self.points[vertex as usize]);
        let [za, zb, zc] = corners.map(|vertex| self.heights_m[vertex as usize]);
        let (bu, bv) = ((b.u - a.u) as f64, (b.v - a.v) as f64);
        let (cu, cv) = ((c.u - a.u) as f64, (c.v - a.v) as f64);
        let total = bu * cv - bv * cu;
        let (wb, wc) = ((du * cv - dv * cu) / total, (bu * dv - bv * du) / total);
        za + (wb * (zb - za) + wc * (zc - za))
    }

    fn bounds_of(&self, vertices: &[u32]) -> LatticeBounds {
        let at = |&vertex: &u32| LatticeBounds::at(self.points[vertex as usize]);
        let first = at(&vertices[0]);
        vertices.iter().map(at).fold(first, |bounds, point| bounds.union(&point))
    }

    /// Searches for the twin around the end of the edge that has fewer triangles: linear in total
    /// for a planar TIN, and far from quadratic even for others.
    ///
    /// An edge of more than two triangles, or of two on the same side, has no twins: such a TIN is
    /// damaged, but every method must still end on it.
    fn find_twin(&self, half_edge: u32) -> u32 {
        let [a, b] = self.ends(half_edge);
        let (hub, rim) = if self.fan(a).len() <= self.fan(b).len() { (a, b) } else { (b, a) };
        let mut found = [NO_TWIN; 2];
        let mut counts = [0_u32; 2];
        for &out in self.fan(hub) {
            let into = previous(out);
            for (way, candidate, far) in
                [(0, out, self.ends(out)[1]), (1, into, self.ends(into)[0])]
            {
                if far == rim {
                    found[way] = candidate;
                    counts[way] += 1;
                }
            }
        }
        match (counts, found) {
            ([1, 1], [one, other]) if one == half_edge => other,
            ([1, 1], [one, _]) => one,
            _ => NO_TWIN,
        }
    }
}

/// The half-edge before this one in its triangle.
fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}

#[cfg(test)]
#[path = "surface_tests.rs"]
mod tests;
