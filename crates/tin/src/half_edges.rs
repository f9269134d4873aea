//! The mesh for greedy insertion: faces in one flat vector, Delaunay by exact integer arithmetic.

use crate::TinVertex;
pub(crate) use crate::surface::NO_TWIN;

/// A triangle, counter-clockwise in columns and rows.
///
/// ```text
///             c             Edge k runs from corner k to the next one. Its half-edge has the number 4 · face + k:
///            ╱ ╲            a face and a place are read off it without a division.
///     edge 2╱   ╲edge 1     A twin is the half-edge of the face on the other side.
///          ╱     ╲
///         a───────b
///           edge 0
/// ```
#[derive(Debug, Clone, Copy)]
pub(crate) struct Face {
    pub corners: [TinVertex; 3],
    pub twins: [u32; 3],
    /// The farthest node of the face, stored here because it is read together with the face. 0 m
    /// until the face is scanned.
    pub farthest: Farthest,
}

/// The farthest node of a face.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Farthest {
    pub far_m: f32,
    /// The index of the node, row by row.
    pub node: u32,
}

impl Face {
    pub(crate) fn new(corners: [TinVertex; 3], twins: [u32; 3]) -> Self {
        Self { corners, twins, farthest: Farthest::default() }
    }
}

/// The faces on the ground of a tile.
///
/// The mesh begins as the (constrained) Delaunay triangulation of border and boundaries, see
/// [`fixed_mesh`](crate::fixed_mesh), and [`insert`](Self::insert) preserves this property. Faces
/// of voids are omitted, so an edge that must be preserved is an edge without a twin.
#[derive(Debug, Default)]
pub(crate) struct HalfEdges {
    faces: Vec<Face>,
    /// Whether no two nodes are more than [`NARROW`] columns or rows apart.
    narrow: bool,
    /// The faces around the last inserted vertex, counter-clockwise.
    star: Vec<u32>,
    /// The edges around that star, one per face.
    rim: Vec<RimEdge>,
    /// The edges that are still to be examined.
    ahead: Vec<Edge>,
}

/// An edge of the rim: the half-edge outside, and the corner at its start, seen from inside.
#[derive(Debug, Clone, Copy)]
struct RimEdge {
    outside: u32,
    from: TinVertex,
}

/// An edge that may have to be removed.
#[derive(Debug, Clone, Copy)]
struct Edge {
    outside: u32,
    from_corner: TinVertex,
    from: Away,
    to: Away,
}

/// A corner relative to the node that is being inserted, and the square of its distance.
#[derive(Debug, Clone, Copy)]
struct Away {
    x: i64,
    y: i64,
    squared: i64,
}

impl Away {
    fn from_corner(corner: TinVertex, seen_from: TinVertex) -> Self {
        let x = i64::from(corner.column) - i64::from(seen_from.column);
        let y = i64::from(corner.row) - i64::from(seen_from.row);
        Self { x, y, squared: x * x + y * y }
    }
}

/// For smaller differences of columns and rows, the determinant of [`holds_origin`] fits in 64
/// bits.
const NARROW: usize = 1 << 15;

impl HalfEdges {
    /// Creates a mesh of faces with their twins, for a tile of at most `side` columns and rows.
    pub(crate) fn new(faces: Vec<Face>, side: usize) -> Self {
        let star = (0..faces.len() as u32).collect();
        Self { faces, star, narrow: side <= NARROW, ..Self::default() }
    }

    pub(crate) fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// Stores the result of `scan` in each face that the last insertion created.
    #[inline]
    pub(crate) fn scan_star(&mut self, scan: impl Fn([TinVertex; 3]) -> Farthest) {
        for &face in &self.star {
            let face = &mut self.faces[face as usize];
            face.farthest = scan(face.corners);
        }
    }

    /// The faces that the last insertion created, around its vertex and counter-clockwise; before
    /// the first insertion, all faces.
    pub(crate) fn star(&self) -> &[u32] {
        &self.star
    }

    /// Makes `at` a vertex; the new faces are those around it. `face` contains the node, inside or
    /// on an edge with a twin.
    ///
    /// The final result of Lawson's flips is built at once: the faces whose circles contain the
    /// node form a star-shaped hole, found from face to face, and the new faces extend from its rim
    /// to the node. Each flip would remove one edge of that hole, in any order, so both methods
    /// give the same faces. A node on an edge needs no special case: the circle of the face behind
    /// that edge contains it, too. Faces of the hole are reused, so a face keeps its number as long
    /// as it does not change.
    ///
    /// Sources: Bowyer 1981, *Computing Dirichlet tessellations*; Watson 1981, *Computing the
    /// n-dimensional Delaunay tessellation*; Lawson 1977, *Software for C¹ surface interpolation*,
    /// whose criterion keeps the edge between four nodes on one circle.
    pub(crate) fn insert(&mut self, face: u32, at: TinVertex) {
        self.open_hole(face, at);
        let first_new = self.faces.len() as u32;
        self.star.extend([first_new, first_new + 1]);
        assert!(first_new < u32::MAX / 4 - 2, "a mesh has at most 2^30 faces");
        let none = Face::new([at; 3], [NO_TWIN; 3]);
        self.faces.extend([none, none]);

        debug_assert_eq!(
            self.star.len(),
            self.rim.len(),
            "a star has a face for every edge of its rim"
        );
        let mut before = self.star[self.star.len() - 1];
        for (k, (&face, edge)) in self.star.iter().zip(&self.rim).enumerate() {
            let after = self.star.get(k + 1).unwrap_or(&self.star[0]);
            let to = self.rim.get(k + 1).unwrap_or(&self.rim[0]).from;
            self.faces[face as usize] =
                Face::new([at, edge.from, to], [4 * before + 2, edge.outside, 4 * after]);
            if edge.outside != NO_TWIN {
                self.faces[edge.outside as usize / 4].twins[edge.outside as usize % 4] =
                    4 * face + 1;
            }
            before = face;
        }
    }

    /// Finds the faces whose circles contain `at`, and the rim around them, counter-clockwise.
    fn open_hole(&mut self, face: u32, at: TinVertex) {
        self.star.clear();
        self.rim.clear();
        self.star.push(face);
        let Face { corners, twins, .. } = self.faces[face as usize];
        let away = corners.map(|corner| Away::from_corner(corner, at));
        let edge = |k: usize| Edge {
            outside: twins[k],
            from_corner: corners[k],
            from: away[k],
            to: away[(k + 1) % 3],
        };
        self.ahead.extend([edge(2), edge(1)]);
        let mut next = Some(edge(0));
        while let Some(edge) = next {
            let Edge { outside, from_corner, from, to } = edge;
            if outside != NO_TWIN {
                let beyond = &self.faces[outside as usize / 4];
                let k = outside as usize % 4;
                let (after, before) = (AFTER[k], BEFORE[k]);
                let corner = beyond.corners[before];
                let apex = Away::from_corner(corner, at);
                if holds_origin(to, from, apex, self.narrow) {
                    self.star.push(outside / 4);
                    self.ahead.push(Edge {
                        outside: beyond.twins[before],
                        from_corner: corner,
                        from: apex,
                        to,
                    });
                    next = Some(Edge { outside: beyond.twins[after], from_corner, from, to: apex });
                    continue;
                }
            }
            self.rim.push(RimEdge { outside, from: from_corner });
            next = self.ahead.pop();
        }
    }
}

/// The index of the next corner, and of the previous one.
const AFTER: [usize; 4] = [1, 2, 0, 0];
const BEFORE: [usize; 4] = [2, 0, 1, 0];

/// Whether the circle through three counter-clockwise corners contains the origin in its interior.
/// Exact.
///
/// The determinant of the rows (x, y, x² + y²) is a sum of three products. If all four nodes are in
/// a square of side L, the square of a distance is at most 2 L², and two corners and the origin
/// form a triangle of at most half the square, so their cross product is at most L². So every
/// intermediate sum is at most 6 L⁴: below 2^63 for L ≤ 2^15, and below 2^67 for any tile.
#[inline]
fn holds_origin(a: Away, b: Away, c: Away, narrow: bool) -> bool {
    let cross = |p: Away, q: Away| p.x * q.y - p.y * q.x;
    let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
    if narrow {
        return a.squared * bc + b.squared * ca + c.squared * ab > 0;
    }
    let wide = |squared: i64, cross: i64| i128::from(squared) * i128::from(cross);
    wide(a.squared, bc) + wide(b.squared, ca) + wide(c.squared, ab) > 0
}

#[cfg(test)]
#[path = "half_edges_tests.rs"]
mod tests;
