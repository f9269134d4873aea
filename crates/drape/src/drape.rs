//! A line is laid on a TIN, with a vertex at each edge that it crosses.

use corniche_geom::{LatticeBounds, LatticePoint, Polyline, TooMuchWork, Work, cross};
use corniche_tin::{NO_TWIN, Surface};

use crate::{
    DrapedLine, DrapedVertex,
    fraction::Fraction,
    ray::{Next, PlaceOnTin, Ray},
};

/// Steps of [`Work`] that a vertex of a draped line counts for; looking at an edge is one. A vertex is placed, gets a bed and is drawn
/// later on.
const STEPS_OF_VERTEX: usize = 32;

/// A line laid on the ground.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drape {
    /// The parts over ground, in order.
    pub lines: Vec<DrapedLine>,
    /// For each of them the segment on which it begins; of one that begins at a point it is the segment that comes to the point, if there is one.
    pub starts: Vec<usize>,
    /// What lies over no ground, in order.
    pub gaps: Vec<Gap>,
}

/// A stretch of a segment over no ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// Which segment of the line.
    pub segment: usize,
    /// Where it begins and ends, as shares of the segment.
    pub shares: [f64; 2],
}

/// Lays `line` on `surface`: a vertex at every source point, at every TIN edge crossed in its inside, and at
/// every TIN vertex passed through. What lies over no ground is cut out and measured.
///
/// The boundary of the ground belongs to the ground: a line along it is kept. Where a line only touches ground at a
/// point, nothing is kept. A source point on an edge or a TIN vertex is a source point and nothing else, and names
/// the triangle with the smallest index of those that hold it. Coordinates are below 2^60, so that products of their
/// differences fit 128 bits.
///
/// Source: Vaaraniemi, Treib & Westermann 2011, *High-Quality Cartographic Roads on High-Resolution DEMs*,
/// section 6.1. Its barycentric coordinates are exact whole numbers here (`Barycentric`).
#[must_use]
pub fn drape(line: &Polyline, surface: &Surface) -> Drape {
    drape_within(line, surface, &Work::unlimited()).unwrap_or_default()
}

/// The same within a limit of work, for lines that somebody else made: the vertices follow from the triangles that a line crosses, not
/// from its own points.
///
/// # Errors
/// When the limit is passed.
pub fn drape_within(line: &Polyline, surface: &Surface, work: &Work) -> Result<Drape, TooMuchWork> {
    let points = line.points();
    let room = 2 * points.len();
    let drape = Drape::default();
    let mut walk =
        Walk { surface, drape, segment: 0, begun: 0, part: None, room, near: Vec::new(), work };
    let mut place = PlaceOnTin::of(points[0], surface);
    walk.arrive(points[0], place);
    for (segment, pair) in points.windows(2).enumerate() {
        walk.segment = segment;
        place = walk.follow([pair[0], pair[1]], place);
        work.check()?;
    }
    walk.close(None);
    Ok(walk.drape)
}

struct Walk<'a> {
    surface: &'a Surface,
    drape: Drape,
    /// The segment being followed.
    segment: usize,
    /// The segment on which the part began.
    begun: usize,
    /// The part being laid, while on ground.
    part: Option<DrapedLine>,
    /// Vertices that the first part is made for; it may get more.
    room: usize,
    /// Half-edges found near a gap; a field so that its memory is reused.
    near: Vec<u32>,
    work: &'a Work,
}

/// Where a segment comes onto the ground.
#[derive(Clone, Copy)]
enum Entry {
    Edge(u32),
    Vertex(u32),
}

impl Walk<'_> {
    /// Follows one segment from p, which lies at `place`; tells where q lies.
    fn follow(&mut self, [p, q]: [LatticePoint; 2], place: PlaceOnTin) -> PlaceOnTin {
        let ray = Ray { surface: self.surface, p, q };
        // Where along the segment the ground was left or a TIN vertex passed, for when it ends there.
        let mut last = Fraction::ZERO;
        let mut next = ray.leave_start(place);
        loop {
            next = match next {
                Next::Arrives(place) => {
                    self.arrive(q, place);
                    return place;
                }
                Next::Crosses { half_edge, a, b } => {
                    self.push(DrapedVertex::Crossing { a: a.min(b), b: a.max(b) });
                    match self.surface.twin(half_edge) {
                        NO_TWIN => {
                            last = ray.coordinate([a, b]).zero();
                            Next::Ends
                        }
                        twin => ray.entered(twin),
                    }
                }
                Next::Passes(vertex) => {
                    self.push(DrapedVertex::Vertex { vertex });
                    last = Fraction::of_point([p, q], ray.point(vertex));
                    ray.leave_vertex(vertex)
                }
                Next::Ends => {
                    self.close(Some(q));
                    let Some((back, entry)) = self.entry_after(&ray, last) else {
                        self.leave_out([last.to_f64(), 1.0]);
                        // The end may still touch ground, and the next segment may continue from there.
                        let place = PlaceOnTin::of(q, self.surface);
                        self.arrive(q, place);
                        return place;
                    };
                    self.leave_out([last.to_f64(), back.to_f64()]);
                    last = back;
                    let (first, next) = match entry {
                        Entry::Edge(half_edge) => {
                            let [a, b] = self.surface.ends(half_edge);
                            (
                                DrapedVertex::Crossing { a: a.min(b), b: a.max(b) },
                                ray.entered(half_edge),
                            )
                        }
                        Entry::Vertex(vertex) => {
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

    /// The first place after `last` where the segment comes onto ground before its end.
    fn entry_after(&mut self, ray: &Ray, last: Fraction) -> Option<(Fraction, Entry)> {
        let Ray { p, q, .. } = *ray;
        let bounds = LatticeBounds::of(&[p, q])?;
        self.surface.boundary_near(bounds, &mut self.near);
        self.work.add(self.near.len());
        // The caller learns of it; nothing is looked for any more.
        self.work.check().ok()?;
        let mut first: Option<(Fraction, Entry)> = None;
        for &half_edge in &self.near {
            let [a, b] = self.surface.ends(half_edge);
            let (at_a, at_b) = (ray.point(a), ray.point(b));
            let side_a = cross(p, q, at_a);
            let (at, entry) = if side_a == 0 {
                (Fraction::of_point([p, q], at_a), Entry::Vertex(a))
            } else if side_a > 0 && cross(p, q, at_b) < 0 {
                (ray.coordinate([a, b]).zero(), Entry::Edge(half_edge))
            } else {
                continue;
            };
            let sooner =
                at > last && at < Fraction::ONE && first.is_none_or(|(known, _)| at < known);
            let leads_on = match entry {
                Entry::Edge(_) => true,
                Entry::Vertex(vertex) => sooner && ray.leave_vertex(vertex) != Next::Ends,
            };
            if sooner && leads_on {
                first = Some((at, entry));
            }
        }
        first
    }

    /// Notes a stretch of the segment as off the ground.
    fn leave_out(&mut self, shares: [f64; 2]) {
        self.drape.gaps.push(Gap { segment: self.segment, shares });
    }

    /// Adds a source point, if it lies on ground.
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

    /// Ends the part; `towards` is the source point that the line goes on to.
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
