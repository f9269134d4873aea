//! The part of a triangle that lies near a segment.

use corniche_tin::Surface;

use crate::cut_polygon::Polygon;

/// The rectangle around a segment, in coordinates along and across it.
pub(crate) struct SegmentRectangle {
    p: [f64; 2],
    east: f64,
    north: f64,
    length: f64,
    /// How far it reaches beyond the start and the end.
    beyond: [f64; 2],
    /// How far it reaches to both sides.
    margin: f64,
}

impl SegmentRectangle {
    /// Around the segment from `p` to `q`, reaching `margin` beyond it on every side, all in lattice steps.
    pub(crate) fn new([p, q]: [[f64; 2]; 2], margin: f64) -> Self {
        let (du, dv) = (q[0] - p[0], q[1] - p[1]);
        let length = libm::hypot(du, dv);
        let [east, north] = if length > 0.0 { [du / length, dv / length] } else { [1.0, 0.0] };
        Self { p, east, north, length, beyond: [margin; 2], margin }
    }

    /// The rectangle beside `length` steps from `p` on in a direction of length 1, reaching `margin` to both sides, and beyond the start
    /// and the end by so much.
    pub(crate) fn beside(
        p: [f64; 2],
        [east, north]: [f64; 2],
        length: f64,
        margin: f64,
        beyond: [f64; 2],
    ) -> Self {
        Self { p, east, north, length, beyond, margin }
    }

    /// Whether so many square steps of ground are all of it.
    pub(crate) fn is_covered(&self, covered: f64) -> bool {
        /// The share that may seem to be without ground although all of it is covered: rounding of areas.
        const UNCOVERED: f64 = 1e-9;
        let area = (self.length + self.beyond[0] + self.beyond[1]) * 2.0 * self.margin;
        covered >= (1.0 - UNCOVERED) * area
    }

    /// What of a triangle lies in the rectangle.
    pub(crate) fn part_of(&self, triangle: u32, surface: &Surface) -> Polygon {
        let Self { p, east, north, length, beyond, margin } = *self;
        let corners = surface.triangles()[triangle as usize].map(|vertex| {
            let point = surface.points()[vertex as usize];
            let (du, dv) = (point.u as f64 - p[0], point.v as f64 - p[1]);
            let height_m = surface.heights_m()[vertex as usize];
            [du * east + dv * north, dv * east - du * north, height_m]
        });
        // Most triangles lie wholly inside, or wholly beyond one side.
        let range = |axis: usize| {
            let [a, b, c] = corners.map(|corner| corner[axis]);
            [a.min(b).min(c), a.max(b).max(c)]
        };
        let ([along_min, along_max], [across_min, across_max]) = (range(0), range(1));
        let (last, first) = (length + beyond[1], -beyond[0]);
        if along_max < first || along_min > last || across_max < -margin || across_min > margin {
            return Polygon::NONE;
        }
        let mut polygon = Polygon::of(corners);
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
