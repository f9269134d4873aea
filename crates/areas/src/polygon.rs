use corniche_geom::{LatticePoint, cross};

/// A closed line that neither touches nor crosses itself. The first point is not repeated at the end.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ring {
    points: Vec<LatticePoint>,
}

/// A connected area: an outer ring, counter-clockwise, and rings around its holes, clockwise.
///
/// Rings of a polygon may touch at points, and never cross or share a segment.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Polygon {
    outer: Ring,
    holes: Vec<Ring>,
}

impl Ring {
    /// `points` are at least three, all different, and make no crossing. The ring begins at its smallest point.
    pub(crate) fn new(mut points: Vec<LatticePoint>) -> Self {
        let smallest = points.iter().enumerate().min_by_key(|(_, point)| **point);
        let first = smallest.map_or(0, |(index, _)| index);
        points.rotate_left(first);
        Self { points }
    }

    /// Its points in order.
    #[must_use]
    pub fn points(&self) -> &[LatticePoint] {
        &self.points
    }

    /// Its segments, the one that closes it last.
    pub fn segments(&self) -> impl Iterator<Item = [LatticePoint; 2]> {
        let next = self.points.iter().cycle().skip(1);
        self.points.iter().zip(next).map(|(&from, &to)| [from, to])
    }

    /// Twice the area inside in square lattice steps; negative for a clockwise ring.
    #[must_use]
    pub fn doubled_area(&self) -> i128 {
        let Some(&first) = self.points.first() else { return 0 };
        self.segments().map(|[from, to]| cross(first, from, to)).sum()
    }
}

impl Polygon {
    /// `outer` is counter-clockwise, `holes` are clockwise and inside.
    pub(crate) fn new(outer: Ring, mut holes: Vec<Ring>) -> Self {
        holes.sort_unstable();
        Self { outer, holes }
    }

    /// What is around it.
    #[must_use]
    pub fn outer(&self) -> &Ring {
        &self.outer
    }

    /// What is cut out of it, in order of their smallest points.
    #[must_use]
    pub fn holes(&self) -> &[Ring] {
        &self.holes
    }

    /// All rings, the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// Twice its area in square lattice steps, without the holes.
    #[must_use]
    pub fn doubled_area(&self) -> i128 {
        self.rings().map(Ring::doubled_area).sum()
    }
}
