//! Lines for the comparison with brute force: through vertices, along edges, over voids and beyond
//! the ground.

use corniche_geom::{LatticeBounds, LatticePoint};
use corniche_tin::Surface;

use corniche_testing::Random;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Course {
    /// Two to seven points of all the kinds below.
    Mixed,
    /// Through TIN vertices, and beyond them.
    ThroughVertices,
    /// Along edges and their extensions: whole, in part, back and forth, over several edges in one
    /// line.
    AlongEdges,
    /// Along the sides of the TIN's rectangle and around its corners.
    OnBorders,
    /// Lines that start, bend and end on edges and vertices.
    OnEdges,
    /// Repeated points, and steps of one.
    ZeroLength,
    /// Lines that return on themselves, completely or in part.
    Hairpins,
    /// Out of the rectangle and back in, several times.
    LeavesAndReturns,
    /// Up to 2^46 steps away.
    FarLonger,
    /// Nowhere near the TIN, or only around it.
    Outside,
    /// A ring, closed on a vertex, on an edge or elsewhere, often with two turns.
    Ring,
    /// A star that crosses itself.
    SelfCrossing,
}

impl Course {
    pub(crate) const ALL: [Self; 12] = [
        Self::Mixed,
        Self::ThroughVertices,
        Self::AlongEdges,
        Self::OnBorders,
        Self::OnEdges,
        Self::ZeroLength,
        Self::Hairpins,
        Self::LeavesAndReturns,
        Self::FarLonger,
        Self::Outside,
        Self::Ring,
        Self::SelfCrossing,
    ];

    /// Generates two points or more; neighbouring points may be equal.
    pub(crate) fn make(self, random: &mut Random, surface: &Surface) -> Vec<LatticePoint> {
        let mut place = Places { random, surface, bounds: bounds(surface) };
        let count = 2 + place.random.below(6) as usize;
        match self {
            Self::Mixed => mixed(&mut place, count),
            Self::ThroughVertices => through_vertices(&mut place, count),
            Self::AlongEdges => along_edges(&mut place, count),
            Self::OnBorders => (0..count).map(|_| place.on_border()).collect(),
            Self::OnEdges => (0..count).map(|_| place.on_edge()).collect(),
            Self::ZeroLength => zero_length(&mut place, count),
            Self::Hairpins => hairpins(&mut place, count),
            Self::LeavesAndReturns => (0..count + 2)
                .map(|n| if n % 2 == 0 { place.inside() } else { place.outside() })
                .collect(),
            Self::FarLonger => far_longer(&mut place, count),
            Self::Outside => outside(&mut place, count),
            Self::Ring => ring(&mut place, count + 1),
            Self::SelfCrossing => (0..2 * count + 3).map(|_| place.any()).collect(),
        }
    }
}

fn bounds(surface: &Surface) -> LatticeBounds {
    let corner = surface.points()[0];
    LatticeBounds::around(surface.points()).unwrap_or(LatticeBounds { min: corner, max: corner })
}

fn on(from: LatticePoint, to: LatticePoint, part: i64, parts: i64) -> LatticePoint {
    LatticePoint::new(
        from.u + (to.u - from.u) * part / parts,
        from.v + (to.v - from.v) * part / parts,
    )
}

/// Points of every kind.
struct Places<'a> {
    random: &'a mut Random,
    surface: &'a Surface,
    bounds: LatticeBounds,
}

impl Places<'_> {
    fn vertex(&mut self) -> LatticePoint {
        self.random.one_of(self.surface.points())
    }

    /// The ends of an edge, in either order.
    fn edge(&mut self) -> [LatticePoint; 2] {
        let half_edge = self.random.below(3 * self.surface.triangles().len() as i64) as u32;
        let [a, b] =
            self.surface.ends(half_edge).map(|vertex| self.surface.points()[vertex as usize]);
        if self.random.below(2) == 0 { [a, b] } else { [b, a] }
    }

    /// A point on an edge (as near as the lattice allows), its ends included.
    fn on_edge(&mut self) -> LatticePoint {
        let [a, b] = self.edge();
        on(a, b, self.random.below(5), 4)
    }

    fn inside(&mut self) -> LatticePoint {
        let LatticeBounds { min, max } = self.bounds;
        LatticePoint::new(
            min.u + self.random.below(max.u - min.u + 1),
            min.v + self.random.below(max.v - min.v + 1),
        )
    }

    fn outside(&mut self) -> LatticePoint {
        let LatticeBounds { min, max } = self.bounds;
        let reach = 1 + self.random.below(2 * (max.u - min.u));
        let at = self.inside();
        match self.random.below(4) {
            0 => LatticePoint::new(min.u - reach, at.v),
            1 => LatticePoint::new(max.u + reach, at.v),
            2 => LatticePoint::new(at.u, min.v - reach),
            _ => LatticePoint::new(at.u, max.v + reach),
        }
    }

    fn on_border(&mut self) -> LatticePoint {
        let LatticeBounds { min, max } = self.bounds;
        let at = if self.random.below(2) == 0 { self.vertex() } else { self.inside() };
        match self.random.below(6) {
            0 => LatticePoint::new(min.u, at.v),
            1 => LatticePoint::new(max.u, at.v),
            2 => LatticePoint::new(at.u, min.v),
            3 => LatticePoint::new(at.u, max.v),
            4 => LatticePoint::new(
                self.random.one_of(&[min.u, max.u]),
                self.random.one_of(&[min.v, max.v]),
            ),
            _ => at,
        }
    }

    fn any(&mut self) -> LatticePoint {
        match self.random.below(6) {
            0 => self.vertex(),
            1 => self.on_edge(),
            2 => self.outside(),
            3 => self.on_border(),
            _ => self.inside(),
        }
    }
}

fn mixed(place: &mut Places<'_>, count: usize) -> Vec<LatticePoint> {
    let mut points: Vec<LatticePoint> = Vec::new();
    for _ in 0..count {
        let (vertex, other) = (place.vertex(), place.vertex());
        let last = points.last().copied().unwrap_or(vertex);
        points.push(match place.random.below(10) {
            0..=2 => vertex,
            // A point on an edge, or between any two vertices.
            3 => on(vertex, other, 1, 2),
            // A point farther along the line through the last point and a vertex.
            4 => LatticePoint::new(2 * vertex.u - last.u, 2 * vertex.v - last.v),
            // A straight step along grid lines.
            5 => LatticePoint::new(last.u, vertex.v),
            6 => LatticePoint::new(vertex.u, last.v),
            // A hairpin.
            7 if points.len() >= 2 => points[points.len() - 2],
            8 if place.random.below(4) == 0 => LatticePoint::new(
                last.u + 50 * (vertex.u - other.u),
                last.v + 50 * (vertex.v - other.v),
            ),
            _ => place.any(),
        });
    }
    points
}

fn through_vertices(place: &mut Places<'_>, count: usize) -> Vec<LatticePoint> {
    let mut points = vec![place.any()];
    while points.len() < count {
        let (last, vertex) = (points[points.len() - 1], place.vertex());
        // A point at the vertex, beyond it, or on the way back before it.
        let parts = place.random.one_of(&[1, 2, 3]);
        points.push(LatticePoint::new(
            last.u + (vertex.u - last.u) * parts,
            last.v + (vertex.v - last.v) * parts,
        ));
        let far = 1 << 24;
        if points.iter().any(|p| p.u.abs() > far || p.v.abs() > far) {
            break;
        }
    }
    points
}

fn along_edges(place: &mut Places<'_>, count: usize) -> Vec<LatticePoint> {
    let [a, b] = place.edge();
    let (du, dv) = (b.u - a.u, b.v - a.v);
    let mut points = Vec::new();
    for _ in 0..count {
        // A point in eighths of the edge, from well before to well beyond it; exact if the edge
        // allows.
        let (part, parts) =
            (place.random.around(24), if du % 8 == 0 && dv % 8 == 0 { 8 } else { 1 });
        let part = if parts == 1 { part / 8 } else { part };
        points.push(LatticePoint::new(a.u + du * part / parts, a.v + dv * part / parts));
        if place.random.below(6) == 0 {
            points.push(place.vertex());
        }
    }
    points
}

fn zero_length(place: &mut Places<'_>, count: usize) -> Vec<LatticePoint> {
    let mut points = Vec::new();
    for _ in 0..count {
        let at = place.any();
        for _ in 0..=place.random.below(3) {
            points.push(at);
        }
        let step = LatticePoint::new(at.u + place.random.around(1), at.v + place.random.around(1));
        points.extend([step, at]);
    }
    points
}

fn hairpins(place: &mut Places<'_>, count: usize) -> Vec<LatticePoint> {
    let mut points: Vec<LatticePoint> = (0..count).map(|_| place.any()).collect();
    if place.random.below(2) == 0 {
        // The whole way back, and forth again.
        let back: Vec<_> = points.iter().rev().skip(1).copied().collect();
        points.extend(back);
        points.extend_from_within(1..count);
    } else {
        let [from, to] = [points[count - 2], points[count - 1]];
        for part in [1, 3, 0, 2] {
            points.push(on(from, to, part, 4));
        }
    }
    points
}

fn far_longer(place: &mut Places<'_>, count: usize) -> Vec<LatticePoint> {
    let mut points = Vec::new();
    for n in 0..count {
        let far = 1_i64 << (30 + place.random.below(17));
        let at = place.any();
        points.push(match place.random.below(4) {
            // Straight along a grid line; through a vertex with a slope; anywhere.
            0 => LatticePoint::new(at.u + place.random.one_of(&[-far, far]), at.v),
            1 => LatticePoint::new(at.u, at.v + place.random.one_of(&[-far, far])),
            2 => {
                LatticePoint::new(at.u + place.random.around(far), at.v + place.random.around(far))
            }
            _ => at,
        });
        if n > 0 && place.random.below(3) == 0 {
            // The mirror image in a vertex: the line passes exactly through it.
            let (last, vertex) = (points[n - 1], place.vertex());
            points[n] = LatticePoint::new(2 * vertex.u - last.u, 2 * vertex.v - last.v);
        }
    }
    points
}

fn outside(place: &mut Places<'_>, count: usize) -> Vec<LatticePoint> {
    let LatticeBounds { min, max } = place.bounds;
    let mut points = Vec::new();
    for _ in 0..count {
        // All points on one side, or all around.
        let at = place.outside();
        points.push(LatticePoint::new(max.u + 1 + (at.u - max.u).abs(), at.v));
    }
    if place.random.below(2) == 0 {
        points = [(min.u, min.v), (max.u, min.v), (max.u, max.v), (min.u, max.v), (min.u, min.v)]
            .map(|(u, v)| {
                let away = |at: i64, low: i64| if at == low { at - 1 } else { at + 1 };
                LatticePoint::new(away(u, min.u), away(v, min.v))
            })
            .to_vec();
    }
    points
}

fn ring(place: &mut Places<'_>, count: usize) -> Vec<LatticePoint> {
    let mut points: Vec<LatticePoint> = (0..count).map(|_| place.any()).collect();
    points.push(points[0]);
    if place.random.below(2) == 0 {
        points.extend_from_within(1..);
    }
    points
}
