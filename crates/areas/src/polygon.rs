//! Rings and polygons on the lattice, with their areas in square steps.

use corniche_geom::{LatticeBounds, LatticePoint, doubled_area, ring_edges};

/// A closed line that neither touches nor crosses itself. The first point is not repeated at the
/// end.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ring {
    points: Vec<LatticePoint>,
}

/// A connected area: a counter-clockwise outer ring, and clockwise rings around its holes.
///
/// Rings of a polygon may touch at points, but never cross or share a segment.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Polygon {
    outer: Ring,
    holes: Vec<Ring>,
}

impl Ring {
    /// Creates a ring. `points` are at least three, all different, and form no crossing. The ring
    /// begins at its smallest point.
    pub(crate) fn new(mut points: Vec<LatticePoint>) -> Self {
        let smallest = points.iter().enumerate().min_by_key(|(_, point)| **point);
        let first = smallest.map_or(0, |(index, _)| index);
        points.rotate_left(first);
        Self { points }
    }

    /// Returns the points of the ring in order.
    #[must_use]
    pub fn points(&self) -> &[LatticePoint] {
        &self.points
    }

    /// Returns the segments of the ring; the one that closes it comes last.
    pub fn segments(&self) -> impl Iterator<Item = [LatticePoint; 2]> {
        ring_edges(&self.points)
    }

    /// Returns twice the area inside, in square lattice steps; negative for a clockwise ring.
    #[must_use]
    pub fn doubled_area(&self) -> i128 {
        doubled_area(&self.points)
    }
}

impl Polygon {
    /// Creates a polygon. `outer` is counter-clockwise, `holes` are clockwise and inside it.
    pub(crate) fn new(outer: Ring, mut holes: Vec<Ring>) -> Self {
        holes.sort_unstable();
        Self { outer, holes }
    }

    /// Returns a rectangle; `None` if it has no area.
    #[must_use]
    pub fn rectangle(LatticeBounds { min, max }: LatticeBounds) -> Option<Self> {
        let corners =
            vec![min, LatticePoint::new(max.u, min.v), max, LatticePoint::new(min.u, max.v)];
        let has_area = min.u < max.u && min.v < max.v;
        has_area.then(|| Self::new(Ring::new(corners), Vec::new()))
    }

    /// Returns the outer ring.
    #[must_use]
    pub fn outer(&self) -> &Ring {
        &self.outer
    }

    /// Returns the rings of the holes, in order of their smallest points.
    #[must_use]
    pub fn holes(&self) -> &[Ring] {
        &self.holes
    }

    /// Returns all rings, the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// Returns twice the area in square lattice steps, without the holes.
    #[must_use]
    pub fn doubled_area(&self) -> i128 {
        self.rings().map(Ring::doubled_area).sum()
    }
}

impl Polygon {
    /// Returns the polygon with each point moved by `place`. The rings keep about the same
    /// directions. `None` if a point has no new position, or if so many points coincide that a ring
    /// vanishes.
    #[must_use]
    pub fn placed(
        &self,
        mut place: impl FnMut(LatticePoint) -> Option<LatticePoint>,
    ) -> Option<Self> {
        let mut ring = |ring: &Ring| {
            let points: Option<Vec<_>> = ring.points.iter().map(|&point| place(point)).collect();
            let mut points = points?;
            points.dedup();
            while points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
            Some(points)
        };
        let is_ring = |points: &Vec<LatticePoint>| points.len() >= 3;
        let outer = Some(ring(&self.outer)?).filter(is_ring).map(Ring::new)?;
        let holes: Option<Vec<_>> = self.holes.iter().map(ring).collect();
        // A hole that has shrunk to a line is dropped.
        let holes = holes?.into_iter().filter(is_ring).map(Ring::new).collect();
        Some(Self::new(outer, holes))
    }
}
