//! Drapes a line on a TIN, with a vertex at each edge that it crosses.

use corniche_geom::{LatticeBounds, LatticePoint, Polyline, StepBudget, TooMuchWork, cross};
use corniche_tin::{NO_TWIN, Surface};

use crate::{
    DrapedLine, DrapedVertex,
    fraction::Fraction,
    ray::{NextCrossing, PlaceOnTin, SegmentWalk},
};

/// The number of steps of [`StepBudget`] for a vertex of a draped line; examining an edge is one
/// step. Later, a vertex gets a position and a road bed, and is drawn.
const STEPS_OF_VERTEX: usize = 32;

/// A line draped on the ground.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drape {
    /// The parts on ground, in order.
    pub lines: Vec<DrapedLine>,
    /// For each part the segment on which it begins; for a part that begins at a point this is the
    /// segment that ends at the point, if there is one.
    pub starts: Vec<usize>,
    /// The stretches without ground, in order.
    pub gaps: Vec<Gap>,
}

/// A stretch of a segment without ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// The index of the segment in the line.
    pub segment: usize,
    /// The beginning and the end of the stretch, as fractions of the segment.
    pub shares: [f64; 2],
}

/// Drapes `line` on `surface`: adds a vertex at every source point, at every TIN edge that is
/// crossed in its interior, and at every TIN vertex on the line. Stretches without ground are cut
/// out and measured.
///
/// The boundary of the ground belongs to the ground: a line along it is kept. If a line only
/// touches ground at a point, nothing is kept. A source point on an edge or a TIN vertex only
/// counts as a source point, and refers to the triangle with the smallest index among those that
/// contain it. Coordinates must be below 2^60, so that products of their differences fit in 128
/// bits.
///
/// Source: Vaaraniemi, Treib & Westermann 2011, *High-Quality Cartographic Roads on High-Resolution
/// DEMs*, section 6.1. Its barycentric coordinates are exact whole numbers here (`Barycentric`).
#[must_use]
pub fn drape(line: &Polyline, surface: &Surface) -> Drape {
    drape_within(line, surface, &StepBudget::unlimited()).unwrap_or_default()
}

/// Drapes a line like [`drape()`] within a limit of work, for lines from untrusted sources: the
/// number of vertices depends on the triangles that a line crosses, not on its own points.
///
/// # Errors
/// When the limit is exceeded.
pub fn drape_within(
    line: &Polyline,
    surface: &Surface,
    work: &StepBudget,
) -> Result<Drape, TooMuchWork> {
    let points = line.points();
    let room = 2 * points.len();
    let drape = Drape::default();
    let mut walk =
        Walk { surface, drape, segment: 0, begun: 0, part: None, room, near: Vec::new(), work };
    let mut place = PlaceOnTin::locate(points[0], surface);
    walk.arrive(points[0], place);
    for (segment, &ends) in points.array_windows().enumerate() {
        walk.segment = segment;
        place = walk.follow(ends, place);
        work.check()?;
    }
    walk.close(None);
    Ok(walk.drape)
}

struct Walk<'a> {
    surface: &'a Surface,
    drape: Drape,
    /// The index of the current segment.
    segment: usize,
    /// The segment on which the current part began.
    begun: usize,
    /// The current part, while on ground.
    part: Option<DrapedLine>,
    /// The number of vertices for which memory is reserved in the first part; it may get more.
    room: usize,
    /// Half-edges near a gap; a field so that its memory is reused.
    near: Vec<u32>,
    work: &'a StepBudget,
}

/// Where a segment enters the ground.
#[derive(Clone, Copy)]
enum EntryPoint {
    Edge(u32),
    Vertex(u32),
}

impl Walk<'_> {
    /// Follows one segment from p, which is at `place`; returns the place of q.
    fn follow(&mut self, [p, q]: [LatticePoint; 2], place: PlaceOnTin) -> PlaceOnTin {
        let ray = SegmentWalk { surface: self.surface, p, q };
        // The last position along the segment at which the ground ended or a TIN vertex was passed.
        let mut last = Fraction::ZERO;
        let mut next = ray.leave_start(place);
        loop {
            next = match next {
                NextCrossing::Arrives(place) => {
                    self.arrive(q, place);
                    return place;
                }
                NextCrossing::Crosses { half_edge, a, b } => {
                    self.push(DrapedVertex::Crossing { a: a.min(b), b: a.max(b) });
                    match self.surface.twin(half_edge) {
                        NO_TWIN => {
                            last = ray.coordinate([a, b]).zero();
                            NextCrossing::Ends
                        }
                        twin => ray.entered(twin),
                    }
                }
                NextCrossing::Passes(vertex) => {
                    self.push(DrapedVertex::Vertex { vertex });
                    last = Fraction::of_point([p, q], ray.point(vertex));
                    ray.leave_vertex(vertex)
                }
                NextCrossing::Ends => {
                    self.close(Some(q));
                    let Some((back, entry)) = self.entry_after(&ray, last) else {
                        self.leave_out([last.to_f64(), 1.0]);
                        // The end may still touch ground, and the next segment may continue from
                        // there.
                        let place = PlaceOnTin::locate(q, self.surface);
                        self.arrive(q, place);
                        return place;
                    };
                    self.leave_out([last.to_f64(), back.to_f64()]);
                    last = back;
                    let (first, next) = match entry {
                        EntryPoint::Edge(half_edge) => {
                            let [a, b] = self.surface.ends(half_edge);
                            (
                                DrapedVertex::Crossing { a: a.min(b), b: a.max(b) },
                                ray.entered(half_edge),
                            )
                        }
                        EntryPoint::Vertex(vertex) => {
                            (DrapedVertex::Vertex { vertex }, ray.leave_vertex(vertex))
                        }
                    };
                    self.begun = self.segment;
                    self.part = Some(DrapedLine {
                        lead_in: Some(p),
                        vertices: vec![first],
                        lead_out: None,
                    });
                    next
                }
            }
        }
    }

    /// Returns the first position after `last` at which the segment enters ground before its end.
    fn entry_after(&mut self, ray: &SegmentWalk, last: Fraction) -> Option<(Fraction, EntryPoint)> {
        let SegmentWalk { p, q, .. } = *ray;
        let bounds = LatticeBounds::around(&[p, q])?;
        self.surface.boundary_near(bounds, &mut self.near);
        self.work.add(self.near.len());
        // The caller handles the exceeded limit; the search ends.
        self.work.check().ok()?;
        let mut first: Option<(Fraction, EntryPoint)> = None;
        for &half_edge in &self.near {
            let [a, b] = self.surface.ends(half_edge);
            let (at_a, at_b) = (ray.point(a), ray.point(b));
            let side_a = cross(p, q, at_a);
            let (at, entry) = if side_a == 0 {
                (Fraction::of_point([p, q], at_a), EntryPoint::Vertex(a))
            } else if side_a > 0 && cross(p, q, at_b) < 0 {
                (ray.coordinate([a, b]).zero(), EntryPoint::Edge(half_edge))
            } else {
                continue;
            };
            let sooner =
                at > last && at < Fraction::ONE && first.is_none_or(|(known, _)| at < known);
            let leads_on = match entry {
                EntryPoint::Edge(_) => true,
                EntryPoint::Vertex(vertex) => {
                    sooner && ray.leave_vertex(vertex) != NextCrossing::Ends
                }
            };
            if sooner && leads_on {
                first = Some((at, entry));
            }
        }
        first
    }

    /// Records a stretch of the segment as a gap.
    fn leave_out(&mut self, shares: [f64; 2]) {
        self.drape.gaps.push(Gap { segment: self.segment, shares });
    }

    /// Adds a source point if it is on ground.
    fn arrive(&mut self, point: LatticePoint, place: PlaceOnTin) {
        if let Some(triangle) = place.first_triangle(self.surface) {
            self.push(DrapedVertex::Source { point, triangle });
        }
    }

    #[inline]
    fn push(&mut self, vertex: DrapedVertex) {
        self.work.add(STEPS_OF_VERTEX);
        if self.part.is_none() {
            self.begun = self.segment;
        }
        self.part
            .get_or_insert_with(|| DrapedLine {
                lead_in: None,
                vertices: Vec::with_capacity(std::mem::take(&mut self.room)),
                lead_out: None,
            })
            .vertices
            .push(vertex);
    }

    /// Ends the part; `towards` is the source point to which the line continues.
    fn close(&mut self, towards: Option<LatticePoint>) {
        let Some(mut part) = self.part.take() else {
            return;
        };
        if !matches!(part.vertices.last(), Some(DrapedVertex::Source { .. })) {
            part.lead_out = towards;
        }
        if part.vertices.len() >= 2 {
            self.drape.lines.push(part);
            self.drape.starts.push(self.begun);
        }
    }
}

#[cfg(test)]
#[path = "drape_tests.rs"]
mod tests;
