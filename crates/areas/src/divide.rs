//! Divides a polygon by a vertical or horizontal line; both sides get the same new points.

use corniche_geom::LatticePoint;

use crate::{
    Polygon, Ring, assemble::polygons_of, outline::OutlineError, segments::uncrossed_segments_of,
};

/// The axis along which a polygon is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// A vertical line divides the polygon into a western and an eastern part.
    East,
    /// A horizontal line divides the polygon into a southern and a northern part.
    North,
}

/// Returns the parts of a polygon on both sides of a line, the side with smaller coordinates first.
/// Where the polygon is on both sides of the line, both parts cover the same stretch of the line,
/// between the same points. Where the outline runs along the line, only the part on its inner side
/// includes that stretch; the same applies to a corner that only touches the line.
///
/// ```text
///        │                       each ring is cut at the line; what that adds along the line is there
///    ╭───┼──╮                    twice where it joins separate parts:
///    │   │  ╰──╮     ──►     ╭───┐      ┌──╮        ┌──╮
///    │   │  ╭──╯             │   │      │  ╰──╮  =  │  ╰──╮     (the even-odd rule drops it)
///    ╰───┼──╯                ╰───┘      └─────╯     └─────╯
///        │
/// ```
///
/// A segment is cut at the lattice point on the line that is nearest to the crossing. If tiles are
/// cut out of an area by dividing it like a quadtree, neighbours have the same points on their
/// common border, because one division by that line created both.
///
/// Source: Sutherland & Hodgman 1974, *Reentrant Polygon Clipping*, Communications of the ACM 17.
/// Afterwards polygons are assembled again, because that method joins separate parts by segments
/// along the line.
///
/// # Errors
/// [`OutlineError::TooIntricate`], for polygons far beyond what is realistic.
pub fn divide(polygon: &Polygon, axis: Axis, at: i64) -> Result<[Vec<Polygon>; 2], OutlineError> {
    let line = DivisionLine { axis, at };
    let own = || vec![polygon.clone()];
    let points = polygon.outer().points();
    if points.iter().all(|&point| line.along(point) <= at) {
        Ok([own(), Vec::new()])
    } else if points.iter().all(|&point| line.along(point) >= at) {
        Ok([Vec::new(), own()])
    } else {
        Ok([line.part(polygon, LineSide::Smaller)?, line.part(polygon, LineSide::Larger)?])
    }
}

#[derive(Debug, Clone, Copy)]
struct DivisionLine {
    axis: Axis,
    at: i64,
}

#[derive(Debug, Clone, Copy)]
enum LineSide {
    Smaller,
    Larger,
}

impl DivisionLine {
    fn along(self, point: LatticePoint) -> i64 {
        match self.axis {
            Axis::East => point.u,
            Axis::North => point.v,
        }
    }

    fn across(self, point: LatticePoint) -> i64 {
        match self.axis {
            Axis::East => point.v,
            Axis::North => point.u,
        }
    }

    fn part(self, polygon: &Polygon, part: LineSide) -> Result<Vec<Polygon>, OutlineError> {
        let rings: Vec<Vec<LatticePoint>> =
            polygon.rings().map(|ring| self.part_of_ring(ring, part)).collect();
        polygons_of(uncrossed_segments_of(&rings)?)
    }

    /// Returns the points of a ring on one side of the line, with the first repeated at the end.
    /// Points on the line belong to both sides.
    fn part_of_ring(self, ring: &Ring, part: LineSide) -> Vec<LatticePoint> {
        let is_kept = |point: LatticePoint| match part {
            LineSide::Smaller => self.along(point) <= self.at,
            LineSide::Larger => self.along(point) >= self.at,
        };
        let mut kept = Vec::with_capacity(ring.points().len() + 8);
        for [from, to] in ring.segments() {
            if is_kept(from) {
                kept.push(from);
            }
            if is_kept(from) != is_kept(to) {
                kept.push(self.crossing(from, to));
            }
        }
        kept.extend(kept.first().copied());
        kept
    }

    /// Returns the point where a segment crosses the line. The direction of the segment does not
    /// matter.
    fn crossing(self, from: LatticePoint, to: LatticePoint) -> LatticePoint {
        let [a, b] = if self.along(from) < self.along(to) { [from, to] } else { [to, from] };
        let length = i128::from(self.along(b) - self.along(a));
        let run = i128::from(self.across(b) - self.across(a)) * i128::from(self.at - self.along(a));
        // Rounded to the nearest, halves upwards.
        let place = self.across(a) + (2 * run + length).div_euclid(2 * length) as i64;
        match self.axis {
            Axis::East => LatticePoint::new(self.at, place),
            Axis::North => LatticePoint::new(place, self.at),
        }
    }
}

#[cfg(test)]
#[path = "divide_tests.rs"]
mod tests;
