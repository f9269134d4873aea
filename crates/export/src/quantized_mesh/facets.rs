//! A mesh's triangles as flat lists: finds the triangle that contains a place, the triangles along
//! a line, and their heights.

use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation as _};

use crate::{
    globe::{between, dot, geocentric_m},
    plane::doubled_area,
};

/// A corner of triangles, in whole steps of the tile.
#[derive(Clone, Copy)]
pub(crate) struct MeshVertex {
    pub(crate) steps: [u16; 2],
    /// Longitude, latitude and height above the ellipsoid.
    pub(crate) place: [f64; 3],
    /// The height in 32 767ths of the range, after the mesh is finished.
    pub(crate) height: u16,
    /// The position from the earth's centre.
    pub(crate) at_m: [f64; 3],
    /// The normal of the ground, in the same axes.
    pub(crate) normal: [f64; 3],
}

impl HasPosition for MeshVertex {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        let [u, v] = self.steps.map(f64::from);
        Point2::new(u, v)
    }
}

impl MeshVertex {
    pub(crate) fn new(steps: [u16; 2], place: [f64; 3], normal: [f64; 3]) -> Self {
        Self { steps, place, height: 0, at_m: geocentric_m(place), normal }
    }
}

/// The number that means outside the border of the tile, instead of a triangle.
pub(crate) const OUTSIDE: u32 = 0;

/// A place that is outside a side by no more than this counts as on it, in square steps of u and v:
/// more than the rounding error of products below 2³⁰.
const ROUNDING: f64 = 1e-5;

/// The triangles, numbered as in the mesh. Number 0 is [`OUTSIDE`].
#[derive(Default)]
pub(crate) struct Facets {
    /// u and v of each vertex.
    uv: Vec<[f64; 2]>,
    /// Counter-clockwise from above.
    corners: Vec<[u32; 3]>,
    /// The triangle across the side from corner k to the next.
    beyond: Vec<[u32; 3]>,
    /// The position of each vertex, from the origin.
    from_origin_m: Vec<[f64; 3]>,
}

impl Facets {
    /// Returns the triangles with positions relative to `origin_m`, which keeps the numbers small
    /// near it.
    pub(crate) fn new(triangles: &DelaunayTriangulation<MeshVertex>, origin_m: [f64; 3]) -> Self {
        let count = triangles.num_all_faces();
        let mut facets = Self {
            uv: triangles.vertices().map(|vertex| vertex.data().steps.map(f64::from)).collect(),
            corners: vec![[0; 3]; count],
            beyond: vec![[OUTSIDE; 3]; count],
            from_origin_m: triangles
                .vertices()
                .map(|vertex| between(origin_m, vertex.data().at_m))
                .collect(),
        };
        for face in triangles.inner_faces() {
            let index = face.fix().index();
            let sides = face.adjacent_edges();
            facets.corners[index] = sides.map(|side| side.from().fix().index() as u32);
            facets.beyond[index] = sides.map(|side| side.rev().face().fix().index() as u32);
        }
        facets
    }

    /// The number of triangles, including the one that means outside.
    pub(crate) fn len(&self) -> usize {
        self.corners.len()
    }

    /// Whether a triangle has the same corners as in an earlier state of the mesh.
    pub(crate) fn is_as_in(&self, earlier: &Self, face: usize) -> bool {
        earlier.corners.get(face) == Some(&self.corners[face])
    }

    /// Returns the distance of a place to the left of a side, times the length of the side.
    fn beside(&self, face: u32, side: usize, at: [f64; 2]) -> f64 {
        let corners = self.corners[face as usize];
        let [a, b] = [side, (side + 1) % 3].map(|k| self.uv[corners[k] as usize]);
        doubled_area([a, b, at])
    }

    /// Returns the triangle that contains a place of the tile, by walking there from another
    /// triangle; [`OUTSIDE`] for a place outside the tile.
    ///
    /// Source: Devillers, Pion & Teillaud 2002, *Walking in a Triangulation*: the walk ends in any
    /// Delaunay triangulation. Rounding could send it back and forth between two triangles, so it
    /// never returns to the previous one.
    pub(crate) fn locate(&self, from: u32, at: [f64; 2]) -> u32 {
        let mut face = from.max(1);
        let mut before = OUTSIDE;
        for _ in 0..self.len() {
            let is_beyond = |side: &usize| self.beside(face, *side, at) < -ROUNDING;
            let ways = (0..3).filter(is_beyond).map(|side| self.beyond[face as usize][side]);
            let Some(next) = ways.into_iter().find(|&next| next != before || next == OUTSIDE)
            else {
                return face;
            };
            if next == OUTSIDE {
                return OUTSIDE;
            }
            (before, face) = (face, next);
        }
        face
    }

    /// Calls `tell` where a line that begins in a triangle leaves it and the following ones: with
    /// the triangle, and the share of the way. Along a side, rounding could make the share any
    /// number; it never decreases.
    pub(crate) fn for_each_crossing(
        &self,
        first: u32,
        [from, to]: [[f64; 2]; 2],
        mut tell: impl FnMut(u32, f64),
    ) {
        let (mut face, mut before) = (first, OUTSIDE);
        let mut reached = 0.0;
        for _ in 0..self.len() {
            let beyond = self.beyond[face as usize];
            let mut exit: Option<(f64, usize)> = None;
            for side in (0..3).filter(|&side| beyond[side] != before || before == OUTSIDE) {
                let last = self.beside(face, side, to);
                if last < -ROUNDING {
                    let begin = self.beside(face, side, from).max(0.0);
                    let share = begin / (begin - last);
                    if exit.is_none_or(|(known, _)| share < known) {
                        exit = Some((share, side));
                    }
                }
            }
            let Some((share, side)) = exit else { return };
            reached = share.max(reached);
            tell(face, reached);
            if beyond[side] == OUTSIDE {
                return;
            }
            (before, face) = (face, beyond[side]);
        }
    }

    /// Returns the vertical distance of the ground at u and v, given by its position relative to
    /// the origin, above a triangle: above the point of the flat triangle that is at u and v
    /// between its corners. On a side that point depends on the side alone, so that long narrow
    /// triangles next to a border stay near the ground, even if their sides bend in degrees by more
    /// than the triangles' width.
    pub(crate) fn above_m(
        &self,
        face: u32,
        uv: [f64; 2],
        from_origin_m: [f64; 3],
        up: [f64; 3],
    ) -> f64 {
        let corners = self.corners[face as usize];
        // The weight of each corner is the area of the triangle over the opposite side.
        let parts = [1, 2, 0].map(|side| self.beside(face, side, uv));
        let whole: f64 = parts.iter().sum();
        let above = corners
            .map(|vertex| dot(between(self.from_origin_m[vertex as usize], from_origin_m), up));
        (0..3).map(|k| parts[k] / whole * above[k]).sum()
    }
}
