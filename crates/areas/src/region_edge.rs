//! The edge of a region without holes, clockwise.

use corniche_geom::{LatticePoint, LatticeRegion, dot};

use crate::Ring;

/// The edge of a region, and its interior.
pub(crate) struct RegionEdge {
    /// The corners, clockwise.
    corners: Vec<LatticePoint>,
    region: LatticeRegion,
}

/// The position of a point along the edge: the number of the side, and on it the product of the
/// side with the vector to the point.
pub(crate) type AlongEdge = (usize, i128);

impl RegionEdge {
    /// Returns the edge of the region that a counter-clockwise ring encloses; `None` if the region
    /// is empty.
    pub(crate) fn new(outer: &Ring) -> Option<Self> {
        let corners: Vec<LatticePoint> = outer.points().iter().rev().copied().collect();
        let region = LatticeRegion::new(&[vec![corners.clone()]])?;
        Some(Self { corners, region })
    }

    /// Returns the corners, clockwise.
    pub(crate) fn corners(&self) -> &[LatticePoint] {
        &self.corners
    }

    pub(crate) fn region(&self) -> &LatticeRegion {
        &self.region
    }

    fn side(&self, index: usize) -> [LatticePoint; 2] {
        [self.corners[index], self.corners[(index + 1) % self.corners.len()]]
    }

    /// Returns how far inside a point is, in steps; 0 on the edge, negative outside.
    pub(crate) fn distance(&self, point: LatticePoint) -> f64 {
        let (_, distance) = self.nearest_side(point);
        if self.region.contains(point) { distance } else { -distance }
    }

    pub(crate) fn nearest_on_edge(&self, point: LatticePoint) -> LatticePoint {
        let (index, _) = self.nearest_side(point);
        let [from, to] = self.side(index);
        let share = share(from, to, point);
        from.share_of_way(to, share)
    }

    /// Returns the position along the edge of a point on it, even if the point is rounded to the
    /// lattice.
    pub(crate) fn along(&self, point: LatticePoint) -> AlongEdge {
        let (index, _) = self.nearest_side(point);
        let [from, to] = self.side(index);
        let along = dot(from, to, point);
        if along >= dot(from, to, to) {
            ((index + 1) % self.corners.len(), 0)
        } else {
            (index, along.max(0))
        }
    }

    /// Returns the nearest side and its distance; of several, the first.
    fn nearest_side(&self, point: LatticePoint) -> (usize, f64) {
        let mut nearest = (0, f64::INFINITY);
        for index in 0..self.corners.len() {
            let [from, to] = self.side(index);
            let share = share(from, to, point);
            let away =
                |from: i64, to: i64, at: i64| (at - from) as f64 - share * (to - from) as f64;
            let distance = away(from.u, to.u, point.u).hypot(away(from.v, to.v, point.v));
            if distance < nearest.1 {
                nearest = (index, distance);
            }
        }
        nearest
    }
}

/// Returns the position of the nearest point on a side, as a fraction of the side.
fn share(from: LatticePoint, to: LatticePoint, point: LatticePoint) -> f64 {
    (dot(from, to, point) as f64 / dot(from, to, to) as f64).clamp(0.0, 1.0)
}

pub(crate) fn squared_distance(a: LatticePoint, b: LatticePoint) -> i128 {
    dot(b, a, a)
}
