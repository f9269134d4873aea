//! The way of one segment over the triangles, found by exact tests.

use std::cmp::Ordering;

use corniche_geom::{LatticePoint, cross};
use corniche_tin::{NO_TWIN, Surface};

use crate::barycentric::{Barycentric, turn};

/// Where on the ground a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PlaceOnTin {
    /// The point lies outside the ground.
    Off,
    /// The point lies in the inside of a triangle.
    Inside(u32),
    /// The point lies in the inside of the edge of this half-edge.
    Edge(u32),
    /// The point is a TIN vertex.
    Vertex(u32),
}

impl PlaceOnTin {
    pub(crate) fn of(point: LatticePoint, surface: &Surface) -> Self {
        let Some(triangle) = surface.locate(point) else {
            return Self::Off;
        };
        let corners = surface.triangles()[triangle as usize];
        let at = corners.map(|vertex| surface.points()[vertex as usize]);
        let on = [0, 1, 2].map(|k| cross(at[k], at[(k + 1) % 3], point) == 0);
        match on {
            [true, _, true] => Self::Vertex(corners[0]),
            [true, true, _] => Self::Vertex(corners[1]),
            [_, true, true] => Self::Vertex(corners[2]),
            [false, false, false] => Self::Inside(triangle),
            [first, second, _] => {
                Self::Edge(3 * triangle + if first { 0 } else { 2 - u32::from(second) })
            }
        }
    }

    /// The smallest index of the triangles that hold the point; whichever way the place was reached.
    pub(crate) fn first_triangle(self, surface: &Surface) -> Option<u32> {
        match self {
            Self::Off => None,
            Self::Inside(triangle) => Some(triangle),
            // NO_TWIN is the largest number.
            Self::Edge(half_edge) => Some(half_edge.min(surface.twin(half_edge)) / 3),
            Self::Vertex(vertex) => surface.fan(vertex).first().map(|half_edge| half_edge / 3),
        }
    }
}

/// What a segment meets next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Next {
    /// Its own end, which lies here.
    Arrives(PlaceOnTin),
    /// It leaves a triangle through the inside of this half-edge of it, which runs from a to b.
    Crosses { half_edge: u32, a: u32, b: u32 },
    /// It reaches this TIN vertex before its end.
    Passes(u32),
    /// No ground continues from where it is.
    Ends,
}

/// A segment p → q over a surface.
///
/// ```text
///                 c                 Entered across o–d, the segment leaves across d–c when c lies on its
///                / \                left, across c–o when on its right, through c when on it. This is the
///       p ─ ─ ─ /─ ─\─ ─ ► q        smallest positive exit in barycentric coordinates, without their
///              /     \              division (`Barycentric`): one orientation tells the edge, a second
///             o───────d             whether q lies before it.
/// ```
#[derive(Clone, Copy)]
pub(crate) struct Ray<'a> {
    pub(crate) surface: &'a Surface,
    pub(crate) p: LatticePoint,
    pub(crate) q: LatticePoint,
}

impl Ray<'_> {
    /// The way from p on.
    pub(crate) fn leave_start(&self, place: PlaceOnTin) -> Next {
        match place {
            PlaceOnTin::Off => Next::Ends,
            PlaceOnTin::Inside(triangle) => self.through(triangle),
            PlaceOnTin::Edge(half_edge) => self.leave_edge(half_edge),
            PlaceOnTin::Vertex(vertex) => self.leave_vertex(vertex),
        }
    }

    /// The way on from a triangle just entered across its own `half_edge`, whose start lies on the left of the
    /// segment and whose end on the right.
    #[inline]
    pub(crate) fn entered(&self, half_edge: u32) -> Next {
        let triangle = half_edge / 3;
        let k = half_edge % 3;
        let (next, previous) = (3 * triangle + (k + 1) % 3, 3 * triangle + (k + 2) % 3);
        let apex = self.surface.triangles()[triangle as usize][((k + 2) % 3) as usize];
        match turn(self.p, self.q, self.point(apex)) {
            Ordering::Equal => self.towards(apex, PlaceOnTin::Inside(triangle)),
            Ordering::Greater => self.out_of(next),
            Ordering::Less => self.out_of(previous),
        }
    }

    /// The way on from a TIN vertex that lies on the segment, q beyond it.
    pub(crate) fn leave_vertex(&self, vertex: u32) -> Next {
        let hub = self.point(vertex);
        for &out in self.surface.fan(vertex) {
            let triangle = out / 3;
            let across = 3 * triangle + (out + 1) % 3;
            let into = 3 * triangle + (out + 2) % 3;
            let [right, left] = self.surface.ends(across);
            let turn_right = turn(hub, self.point(right), self.q);
            let turn_left = turn(hub, self.point(left), self.q);
            if turn_right.is_eq() && self.ahead(hub, self.point(right)) {
                return self.towards(right, PlaceOnTin::Edge(out));
            }
            if turn_left.is_eq() && self.ahead(hub, self.point(left)) {
                return self.towards(left, PlaceOnTin::Edge(into));
            }
            if turn_right.is_gt() && turn_left.is_lt() {
                return self.out_of(across);
            }
        }
        Next::Ends
    }

    /// The next step from p, which lies in the inside of an edge.
    fn leave_edge(&self, half_edge: u32) -> Next {
        let [a, b] = self.surface.ends(half_edge);
        // On the edge the coordinate is 0, so its sign at the end is that of its rate.
        match self.coordinate([a, b]).sign_at_end() {
            Ordering::Equal => {
                let target = if self.ahead(self.p, self.point(b)) { b } else { a };
                self.towards(target, PlaceOnTin::Edge(half_edge))
            }
            Ordering::Greater => self.through(half_edge / 3),
            Ordering::Less => match self.surface.twin(half_edge) {
                NO_TWIN => Next::Ends,
                twin => self.through(twin / 3),
            },
        }
    }

    /// The way on through the inside of a triangle that holds p in its inside or on an edge.
    fn through(&self, triangle: u32) -> Next {
        let corners = self.surface.triangles()[triangle as usize];
        // The smallest of three exits: it comes before that across the edge before it, and before that across the next one.
        let sides = corners.map(|vertex| turn(self.p, self.q, self.point(vertex)));
        for k in 0..3 {
            let (this, next, previous) = (sides[k], sides[(k + 1) % 3], sides[(k + 2) % 3]);
            if this.is_lt() && next.is_gt() {
                return self.out_of(3 * triangle + k as u32);
            }
            if this.is_eq() && next.is_gt() && previous.is_lt() {
                return self.towards(corners[k], PlaceOnTin::Inside(triangle));
            }
        }
        Next::Ends
    }

    /// Towards the inside of `half_edge` of the triangle it is in.
    #[inline]
    fn out_of(&self, half_edge: u32) -> Next {
        let [a, b] = self.surface.ends(half_edge);
        match self.coordinate([a, b]).sign_at_end() {
            Ordering::Equal => Next::Arrives(PlaceOnTin::Edge(half_edge)),
            Ordering::Greater => Next::Arrives(PlaceOnTin::Inside(half_edge / 3)),
            Ordering::Less => Next::Crosses { half_edge, a, b },
        }
    }

    /// Towards a TIN vertex ahead on the segment's line, over `place`.
    fn towards(&self, vertex: u32, place: PlaceOnTin) -> Next {
        let target = self.point(vertex);
        if target == self.q {
            Next::Arrives(PlaceOnTin::Vertex(vertex))
        } else if self.ahead(target, self.q) {
            Next::Passes(vertex)
        } else {
            Next::Arrives(place)
        }
    }

    /// Whether, of two points on the segment's line, `to` lies in its direction from `from`.
    fn ahead(&self, from: LatticePoint, to: LatticePoint) -> bool {
        let (du, dv) = (self.q.u - self.p.u, self.q.v - self.p.v);
        if du == 0 {
            (to.v - from.v).signum() == dv.signum()
        } else {
            (to.u - from.u).signum() == du.signum()
        }
    }

    /// The barycentric coordinate that is 0 on an edge between two TIN vertices, along the segment.
    #[inline]
    pub(crate) fn coordinate(&self, edge: [u32; 2]) -> Barycentric {
        Barycentric::new([self.p, self.q], edge.map(|vertex| self.point(vertex)))
    }

    #[inline]
    pub(crate) fn point(&self, vertex: u32) -> LatticePoint {
        self.surface.points()[vertex as usize]
    }
}
