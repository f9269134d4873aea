//! The path of one segment over the triangles, found by exact tests.

use std::cmp::Ordering;

use corniche_geom::{LatticePoint, cross};
use corniche_tin::{NO_TWIN, Surface};

use crate::barycentric::{Barycentric, turn};

/// The place of a point on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PlaceOnTin {
    /// The point is outside the ground.
    Off,
    /// The point is in the interior of a triangle.
    Inside(u32),
    /// The point is in the interior of the edge of this half-edge.
    Edge(u32),
    /// The point is a TIN vertex.
    Vertex(u32),
}

impl PlaceOnTin {
    pub(crate) fn locate(point: LatticePoint, surface: &Surface) -> Self {
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

    /// The smallest index of the triangles that contain the point, however the place was reached.
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

/// The next event of a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NextCrossing {
    /// The segment reaches its own end, which is at this place.
    Arrives(PlaceOnTin),
    /// The segment leaves a triangle through the interior of this half-edge of it, which runs from
    /// a to b.
    Crosses { half_edge: u32, a: u32, b: u32 },
    /// The segment reaches this TIN vertex before its end.
    Passes(u32),
    /// No ground continues from the current place.
    Ends,
}

/// A segment p → q over a surface.
///
/// ```text
///                 c                 Entered across o–d, the segment leaves across d–c when c is on its
///                / \                left, across c–o when on its right, through c when on it. This is the
///       p ─ ─ ─ /─ ─\─ ─ ► q        smallest positive exit in barycentric coordinates, without their
///              /     \              division (`Barycentric`): one orientation gives the edge, a second
///             o───────d             says whether q is before it.
/// ```
#[derive(Clone, Copy)]
pub(crate) struct SegmentWalk<'a> {
    pub surface: &'a Surface,
    pub p: LatticePoint,
    pub q: LatticePoint,
}

impl SegmentWalk<'_> {
    /// The path from p on.
    pub(crate) fn leave_start(&self, place: PlaceOnTin) -> NextCrossing {
        match place {
            PlaceOnTin::Off => NextCrossing::Ends,
            PlaceOnTin::Inside(triangle) => self.through(triangle),
            PlaceOnTin::Edge(half_edge) => self.leave_edge(half_edge),
            PlaceOnTin::Vertex(vertex) => self.leave_vertex(vertex),
        }
    }

    /// The path from a triangle that was just entered across its own `half_edge`, whose start is on
    /// the left of the segment and whose end is on the right.
    #[inline]
    pub(crate) fn entered(&self, half_edge: u32) -> NextCrossing {
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

    /// The path from a TIN vertex on the segment, with q beyond it.
    pub(crate) fn leave_vertex(&self, vertex: u32) -> NextCrossing {
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
        NextCrossing::Ends
    }

    /// The next step from p, which is in the interior of an edge.
    fn leave_edge(&self, half_edge: u32) -> NextCrossing {
        let [a, b] = self.surface.ends(half_edge);
        // On the edge the coordinate is 0, so its sign at the end is that of its rate.
        match self.coordinate([a, b]).sign_at_end() {
            Ordering::Equal => {
                let target = if self.ahead(self.p, self.point(b)) { b } else { a };
                self.towards(target, PlaceOnTin::Edge(half_edge))
            }
            Ordering::Greater => self.through(half_edge / 3),
            Ordering::Less => match self.surface.twin(half_edge) {
                NO_TWIN => NextCrossing::Ends,
                twin => self.through(twin / 3),
            },
        }
    }

    /// The path through the interior of a triangle that contains p in its interior or on an edge.
    fn through(&self, triangle: u32) -> NextCrossing {
        let corners = self.surface.triangles()[triangle as usize];
        // The smallest of three exits: it is before the exits across the previous and the next
        // edge.
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
        NextCrossing::Ends
    }

    /// The step towards the interior of `half_edge` of the current triangle.
    #[inline]
    fn out_of(&self, half_edge: u32) -> NextCrossing {
        let [a, b] = self.surface.ends(half_edge);
        match self.coordinate([a, b]).sign_at_end() {
            Ordering::Equal => NextCrossing::Arrives(PlaceOnTin::Edge(half_edge)),
            Ordering::Greater => NextCrossing::Arrives(PlaceOnTin::Inside(half_edge / 3)),
            Ordering::Less => NextCrossing::Crosses { half_edge, a, b },
        }
    }

    /// The step towards a TIN vertex ahead on the segment's line, over `place`.
    fn towards(&self, vertex: u32, place: PlaceOnTin) -> NextCrossing {
        let target = self.point(vertex);
        if target == self.q {
            NextCrossing::Arrives(PlaceOnTin::Vertex(vertex))
        } else if self.ahead(target, self.q) {
            NextCrossing::Passes(vertex)
        } else {
            NextCrossing::Arrives(place)
        }
    }

    /// Whether `to` is ahead of `from` in the direction of the segment, for two points on its line.
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
