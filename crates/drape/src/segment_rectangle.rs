//! The part of a triangle near a segment.

use corniche_tin::Surface;

use crate::cut_polygon::ConvexPolygon;

/// The rectangle around a segment, in coordinates along and across it.
pub(crate) struct SegmentRectangle {
    p: [f64; 2],
    east: f64,
    north: f64,
    length: f64,
    /// The distances by which it extends beyond the start and the end.
    beyond: [f64; 2],
    /// The distance by which it extends to both sides.
    margin: f64,
}

impl SegmentRectangle {
    /// Creates the rectangle around the segment from `p` to `q` that extends `margin` beyond it on
    /// every side, all in lattice steps.
    pub(crate) fn new([p, q]: [[f64; 2]; 2], margin: f64) -> Self {
        let (du, dv) = (q[0] - p[0], q[1] - p[1]);
        let length = libm::hypot(du, dv);
        let [east, north] = if length > 0.0 { [du / length, dv / length] } else { [1.0, 0.0] };
        Self { p, east, north, length, beyond: [margin; 2], margin }
    }

    /// Creates the rectangle along `length` steps from `p` on in a direction of length 1 that
    /// extends `margin` to both sides, and by `beyond` at the start and the end.
    pub(crate) fn beside(
        p: [f64; 2],
        [east, north]: [f64; 2],
        length: f64,
        margin: f64,
        beyond: [f64; 2],
    ) -> Self {
        Self { p, east, north, length, beyond, margin }
    }

    /// Whether this many square steps of ground cover the whole rectangle.
    pub(crate) fn is_covered(&self, covered: f64) -> bool {
        /// The fraction that may seem to be without ground although everything is covered, because
        /// of rounding of areas.
        const UNCOVERED: f64 = 1e-9;
        let area = (self.length + self.beyond[0] + self.beyond[1]) * 2.0 * self.margin;
        covered >= (1.0 - UNCOVERED) * area
    }

    /// The part of a triangle in the rectangle.
    pub(crate) fn part_of(&self, triangle: u32, surface: &Surface) -> ConvexPolygon {
        let Self { p, east, north, length, beyond, margin } = *self;
        let corners = surface.triangles()[triangle as usize].map(|vertex| {
            let point = surface.points()[vertex as usize];
            let (du, dv) = (point.u as f64 - p[0], point.v as f64 - p[1]);
            let height_m = surface.heights_m()[vertex as usize];
            [du * east + dv * north, dv * east - du * north, height_m]
        });
        // Most triangles are completely inside, or completely beyond one side.
        let range = |axis: usize| {
            let [a, b, c] = corners.map(|corner| corner[axis]);
            [a.min(b).min(c), a.max(b).max(c)]
        };
        let ([along_min, along_max], [across_min, across_max]) = (range(0), range(1));
        let (last, first) = (length + beyond[1], -beyond[0]);
        if along_max < first || along_min > last || across_max < -margin || across_min > margin {
            return ConvexPolygon::NONE;
        }
        let mut polygon = ConvexPolygon::from_triangle(corners);
        if along_min < first || along_max > last {
            polygon = polygon.cut(|[along, ..]| along - first).cut(|[along, ..]| last - along);
        }
        if across_min < -margin || across_max > margin {
            polygon =
                polygon.cut(|[_, across, _]| across + margin).cut(|[_, across, _]| margin - across);
        }
        polygon
    }
}
