//! The mesh that greedy insertion works on: faces in one flat vector, Delaunay by exact integer arithmetic.

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
    pub(crate) corners: [TinVertex; 3],
    pub(crate) twins: [u32; 3],
    /// What was found in the face, kept here because it is read where the face is. 0 m until the face is scanned.
    pub(crate) farthest: Farthest,
}

/// The farthest node of a face.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Farthest {
    pub(crate) far_m: f32,
    /// Index of the node, row by row.
    pub(crate) node: u32,
}

impl Face {
    pub(crate) fn new(corners: [TinVertex; 3], twins: [u32; 3]) -> Self {
        Self { corners, twins, farthest: Farthest::default() }
    }
}

/// The faces on the ground of a tile.
///
/// The mesh begins as the (constrained) Delaunay triangulation of border and boundaries, see
/// [`fixed_mesh`](crate::fixed_mesh), and [`insert`](Self::insert) keeps it one. Faces of voids are left out, so an edge
/// that must stay is an edge without a twin.
#[derive(Debug, Default)]
pub(crate) struct HalfEdges {
    faces: Vec<Face>,
    /// Whether no two nodes are more than [`NARROW`] columns or rows apart.
    narrow: bool,
    /// The faces around the vertex inserted last, counter-clockwise.
    star: Vec<u32>,
    /// The edges around that star, as many.
    rim: Vec<RimEdge>,
    /// Edges still to be looked at.
    ahead: Vec<Edge>,
}

/// An edge of the rim: the half-edge outside, and the corner where it starts, seen from inside.
#[derive(Debug, Clone, Copy)]
struct RimEdge {
    outside: u32,
    from: TinVertex,
}

/// An edge that perhaps has to go.
#[derive(Debug, Clone, Copy)]
struct Edge {
    outside: u32,
    from_corner: TinVertex,
    from: Away,
    to: Away,
}

/// A corner as seen from the node that is inserted, and the square of its distance.
#[derive(Debug, Clone, Copy)]
struct Away {
    x: i64,
    y: i64,
    squared: i64,
}

impl Away {
    fn of(corner: TinVertex, seen_from: TinVertex) -> Self {
        let x = i64::from(corner.column) - i64::from(seen_from.column);
        let y = i64::from(corner.row) - i64::from(seen_from.row);
        Self { x, y, squared: x * x + y * y }
    }
}

/// Below this distance of columns and rows, 64 bits hold the determinant of [`holds_origin`].
const NARROW: usize = 1 << 15;

impl HalfEdges {
    /// Takes faces with their twins, of a tile that has at most `side` columns and rows.
    pub(crate) fn new(faces: Vec<Face>, side: usize) -> Self {
        let star = (0..faces.len() as u32).collect();
        Self { faces, star, narrow: side <= NARROW, ..Self::default() }
    }

    pub(crate) fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// Notes what `scan` finds in each face that the last insertion made.
    #[inline]
    pub(crate) fn scan_star(&mut self, scan: impl Fn([TinVertex; 3]) -> Farthest) {
        for &face in &self.star {
            let face = &mut self.faces[face as usize];
            face.farthest = scan(face.corners);
        }
    }

    /// The faces that the last insertion made, around its vertex and counter-clockwise; before the first, all.
    pub(crate) fn star(&self) -> &[u32] {
        &self.star
    }

    /// Makes `at` a vertex; the new faces are those around it. `face` holds it, inside or on an edge with a twin.
    ///
    /// What Lawson's flips would end with is built at once: the faces whose circles hold the node make a star-shaped
    /// hole, found from face to face, and the new faces run from its rim to the node. Each flip would remove one edge of
    /// that hole, in any order, so both give the same faces. A node on an edge is no case of its own: the
    /// circle of the face behind that edge holds it, too. Faces of the hole are used again, so a face keeps its number
    /// as long as it is not changed.
    ///
    /// Sources: Bowyer 1981, *Computing Dirichlet tessellations*; Watson 1981, *Computing the n-dimensional Delaunay
    /// tessellation*; Lawson 1977, *Software for C¹ surface interpolation*, whose criterion leaves the edge of four
    /// nodes on one circle where it is.
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

    /// Finds the faces whose circles hold `at` and the rim around them, counter-clockwise.
    fn open_hole(&mut self, face: u32, at: TinVertex) {
        self.star.clear();
        self.rim.clear();
        self.star.push(face);
        let Face { corners, twins, .. } = self.faces[face as usize];
        let away = corners.map(|corner| Away::of(corner, at));
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
                let apex = Away::of(corner, at);
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

/// The place of the next corner, and of the one before it.
const AFTER: [usize; 4] = [1, 2, 0, 0];
const BEFORE: [usize; 4] = [2, 0, 1, 0];

/// Whether the circle through three counter-clockwise corners holds the origin, not only on its edge. Exact.
///
/// The determinant of the rows (x, y, x² + y²) is a sum of three products. Where all four nodes lie in a square of side
/// L, the square of a distance is at most 2 L², and two corners and the origin span a triangle of at most half the square,
/// so their cross product is at most L². So every sum along the way is at most 6 L⁴: below 2^63 for L ≤ 2^15, and below
/// 2^67 for any tile.
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
