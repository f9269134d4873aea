//! Guesses where a line continues on a TIN, from its source points.
//!
//! The vertices of a draped line nearly always follow from its source points and the TIN: go
//! straight from one point to the next and list the edges that are crossed. Writer and reader guess
//! every vertex by the same exact integer tests, and the section lists only the vertices where the
//! guess is wrong (and where a line ends early): a crossing costs no bits.
//!
//! ```text
//!              c                 From half-edge x ► y (the line p ► q came in over it) or from inside:
//!            /   \               q in the triangle      → the source point q
//!      ────/───────\──► q        c on the line, ahead   → through the vertex c
//!        /  p ► q    \           an edge with its start to the right of p ► q
//!      y ◄──────────── x         and its end to the left → across that edge
//! ```

use corniche_drape::DrapedVertex;
use corniche_geom::{LatticeBounds, LatticePoint, cross};
use corniche_tin::{NO_TWIN, Surface};

use crate::payload::{damage::Result, work_limit::StepBudget};

/// Follows one line, vertex by vertex: the caller first requests a guess, then passes the true
/// vertex.
pub(crate) struct RouteGuess<'a> {
    surface: &'a Surface,
    /// All points: lead-in, source points, lead-out.
    points: &'a [LatticePoint],
    /// Index of the next source point to be reached.
    next: usize,
    /// The end of the source points; the lead-out follows.
    end: usize,
    place: RoutePlace,
    work: &'a StepBudget,
}

#[derive(Clone, Copy)]
enum RoutePlace {
    /// The route is before the first vertex.
    Start,
    /// At a source point, in this triangle or on its border.
    Triangle(u32),
    /// The route is on an edge, about to enter the triangle of this half-edge.
    HalfEdge(u32),
    /// The route is at a TIN vertex.
    Vertex(u32),
    /// The route is on the boundary, going out.
    Outside,
}

impl<'a> RouteGuess<'a> {
    /// Begins a route; `leads` says whether the first and the last of `points` are lead-in and
    /// lead-out. Each examined triangle or edge counts as `work`.
    pub(crate) fn new(
        surface: &'a Surface,
        points: &'a [LatticePoint],
        leads: [bool; 2],
        work: &'a StepBudget,
    ) -> Self {
        let end = points.len() - usize::from(leads[1]);
        Self { surface, points, next: usize::from(leads[0]), end, place: RoutePlace::Start, work }
    }

    /// The TIN on which the line is.
    pub(crate) fn surface(&self) -> &'a Surface {
        self.surface
    }

    /// The next source point to be reached.
    pub(crate) fn next_source(&self) -> Option<LatticePoint> {
        self.points[..self.end].get(self.next).copied()
    }

    /// Guesses the next vertex from the points; `None` if the line ends according to them. Fails if
    /// that takes more work than is allowed.
    pub(crate) fn guess(&self) -> Result<Option<DrapedVertex>> {
        let vertex = self.best_guess();
        self.work.check()?;
        Ok(vertex)
    }

    fn best_guess(&self) -> Option<DrapedVertex> {
        if let RoutePlace::Start = self.place {
            // A line with a lead-in starts on the boundary. Its start is not guessed, because
            // guessing it would need a search.
            let point = if self.next == 0 { self.next_source()? } else { return None };
            return locate(self.surface, point, self.work)
                .map(|triangle| DrapedVertex::Source { point, triangle });
        }
        let (p, q) = (*self.points.get(self.next.checked_sub(1)?)?, *self.points.get(self.next)?);
        let line = GuessSegment { surface: self.surface, p, q, work: self.work };
        let vertex = match self.place {
            RoutePlace::Triangle(triangle) => line.after_point(triangle),
            RoutePlace::HalfEdge(half_edge) => line.ahead(half_edge / 3, p, None),
            RoutePlace::Vertex(vertex) => line.after_vertex(vertex),
            RoutePlace::Start | RoutePlace::Outside => None,
        }?;
        // The lead-out is only a direction and is never reached.
        (self.next < self.end || !matches!(vertex, DrapedVertex::Source { .. })).then_some(vertex)
    }

    /// Moves on to `vertex`, whatever the guess was. Indices must be within the TIN. Fails if that
    /// takes more work than is allowed.
    pub(crate) fn go(&mut self, vertex: DrapedVertex) -> Result<()> {
        self.place = match vertex {
            DrapedVertex::Source { triangle, .. } => {
                self.next += 1;
                RoutePlace::Triangle(triangle)
            }
            DrapedVertex::Crossing { a, b } => {
                self.entering(a, b).map_or(RoutePlace::Outside, RoutePlace::HalfEdge)
            }
            DrapedVertex::Vertex { vertex } => RoutePlace::Vertex(vertex),
        };
        Ok(self.work.check()?)
    }

    /// Returns the half-edge between a and b over which the line enters: it starts to the left of p
    /// ► q.
    fn entering(&self, a: u32, b: u32) -> Option<u32> {
        let (p, q) = (*self.points.get(self.next.checked_sub(1)?)?, *self.points.get(self.next)?);
        let left_start = cross(p, q, self.surface.points()[a as usize]) > 0;
        let [from, to] = if left_start { [a, b] } else { [b, a] };
        let fan = self.surface.fan(from);
        let found = fan.iter().position(|&half_edge| self.surface.ends(half_edge)[1] == to);
        self.work.add(found.map_or(fan.len(), |at| at + 1));
        found.map(|at| fan[at])
    }
}

/// The segment from p to q.
struct GuessSegment<'a> {
    surface: &'a Surface,
    p: LatticePoint,
    q: LatticePoint,
    work: &'a StepBudget,
}

impl GuessSegment<'_> {
    fn corners(&self, triangle: u32) -> [LatticePoint; 3] {
        self.surface.triangles()[triangle as usize]
            .map(|vertex| self.surface.points()[vertex as usize])
    }

    /// Guesses the next vertex within `triangle`, seen from `here`, which is the TIN vertex `at` if
    /// that is given.
    fn ahead(&self, triangle: u32, here: LatticePoint, at: Option<u32>) -> Option<DrapedVertex> {
        let Self { surface, p, q, work } = *self;
        let corners = self.corners(triangle);
        let sides = [0, 1, 2].map(|k| cross(corners[k], corners[(k + 1) % 3], q));
        if sides.iter().all(|&side| side > 0) {
            return Some(DrapedVertex::Source { point: q, triangle });
        }
        if sides.iter().all(|&side| side >= 0) {
            // On a border several triangles contain the point; the one with the smallest index
            // counts.
            return Some(DrapedVertex::Source { point: q, triangle: locate(surface, q, work)? });
        }
        let names = surface.triangles()[triangle as usize];
        let sides = corners.map(|corner| cross(p, q, corner));
        for k in 0..3 {
            let to = (k + 1) % 3;
            if sides[k] < 0 && sides[to] > 0 {
                let (a, b) = (names[k].min(names[to]), names[k].max(names[to]));
                return Some(DrapedVertex::Crossing { a, b });
            }
        }
        let is_ahead = |corner: LatticePoint| {
            let along = |from: i64, to: i64, low: i64, high: i64| {
                i128::from(to - from) * i128::from(high - low)
            };
            along(p.u, q.u, here.u, corner.u) + along(p.v, q.v, here.v, corner.v) > 0
        };
        (0..3)
            .find(|&k| sides[k] == 0 && Some(names[k]) != at && is_ahead(corners[k]))
            .map(|k| DrapedVertex::Vertex { vertex: names[k] })
    }

    /// Whether the line, which is at `here` in the triangle, continues inside the triangle or along
    /// its border.
    fn goes_into(&self, triangle: u32, here: LatticePoint) -> bool {
        let corners = self.corners(triangle);
        (0..3).all(|k| {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            cross(a, b, here) != 0 || cross(a, b, self.q) >= 0
        })
    }

    /// Guesses the vertex after the source point p in `triangle`.
    fn after_point(&self, triangle: u32) -> Option<DrapedVertex> {
        let corners = self.corners(triangle);
        if let Some(k) = corners.iter().position(|&corner| corner == self.p) {
            return self.after_vertex(self.surface.triangles()[triangle as usize][k]);
        }
        if self.goes_into(triangle, self.p) {
            return self.ahead(triangle, self.p, None);
        }
        let on = (0..3).find(|&k| cross(corners[k], corners[(k + 1) % 3], self.p) == 0)?;
        match self.surface.twin(3 * triangle + on as u32) {
            NO_TWIN => None,
            twin => self.ahead(twin / 3, self.p, None),
        }
    }

    /// Guesses the vertex after a TIN vertex on the line.
    fn after_vertex(&self, vertex: u32) -> Option<DrapedVertex> {
        let here = self.surface.points()[vertex as usize];
        let fan = self.surface.fan(vertex);
        let found = fan.iter().position(|half_edge| self.goes_into(half_edge / 3, here));
        self.work.add(found.map_or(fan.len(), |at| at + 1));
        self.ahead(fan[found?] / 3, here, Some(vertex))
    }
}

/// Same as [`Surface::locate`], with steps counted: finds the triangle with the smallest index that
/// contains `point`. In a hostile TIN all triangles may be around one point.
fn locate(surface: &Surface, point: LatticePoint, work: &StepBudget) -> Option<u32> {
    let mut found = None;
    let mut steps = 0;
    surface.visit_triangles_near(LatticeBounds::at(point), |triangle| {
        steps += 1;
        // The triangles around one point come in ascending order.
        if found.is_none() && surface.triangle_holds(triangle, point) {
            found = Some(triangle);
        }
    });
    work.add(steps);
    found
}
