//! The part of a triangle that lies near a segment.

use corniche_tin::Surface;

/// Heights are widened by this part of the largest of them and of their range: far more than f64 rounding in
/// the cut polygons, far less than a height quantum.
pub(crate) const PAD: f64 = 1e-6;

/// A range of heights, widened so that rounding cannot have made it too narrow.
pub(crate) fn padded([lowest_m, highest_m]: [f64; 2]) -> [f64; 2] {
    let pad_m = PAD * lowest_m.abs().max(highest_m.abs()).max(highest_m - lowest_m);
    [lowest_m - pad_m, highest_m + pad_m]
}

/// The rectangle around a segment, in coordinates along and across it.
pub(crate) struct Around {
    p: [f64; 2],
    east: f64,
    north: f64,
    length: f64,
    /// How far it reaches beyond the start and the end.
    beyond: [f64; 2],
    /// How far it reaches to both sides.
    margin: f64,
}

impl Around {
    /// Around the segment from `p` to `q`, reaching `margin` beyond it on every side, all in lattice steps.
    pub(crate) fn new([p, q]: [[f64; 2]; 2], margin: f64) -> Self {
        let (du, dv) = (q[0] - p[0], q[1] - p[1]);
        let length = du.hypot(dv);
        let [east, north] = if length > 0.0 { [du / length, dv / length] } else { [1.0, 0.0] };
        Self { p, east, north, length, beyond: [margin; 2], margin }
    }

    /// Beside `length` steps from `p` on in a direction of length 1, reaching `margin` to both sides, and beyond the start
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

    /// Its area, square steps.
    pub(crate) fn area(&self) -> f64 {
        (self.length + self.beyond[0] + self.beyond[1]) * 2.0 * self.margin
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

/// A convex polygon of a triangle cut by up to four lines: at most seven corners, in place.
/// A corner is [along, across, height].
#[derive(Clone, Copy)]
pub(crate) struct Polygon {
    corners: [[f64; 3]; 8],
    count: usize,
}

impl Polygon {
    const NONE: Self = Self { corners: [[0.0; 3]; 8], count: 0 };

    fn of([a, b, c]: [[f64; 3]; 3]) -> Self {
        let mut corners = [[0.0; 3]; 8];
        corners[..3].copy_from_slice(&[a, b, c]);
        Self { corners, count: 3 }
    }

    /// In order around it; none where nothing is left.
    pub(crate) fn corners(&self) -> &[[f64; 3]] {
        &self.corners[..self.count]
    }

    /// Its area in plan, square steps.
    pub(crate) fn area(&self) -> f64 {
        let corners = self.corners();
        let doubled: f64 = (1..corners.len().max(1) - 1)
            .map(|k| {
                let [a, b, c] = [corners[0], corners[k], corners[k + 1]];
                (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
            })
            .sum();
        doubled.abs() / 2.0
    }

    /// What lies where `inside`, an affine function, is at least 0.
    fn cut(&self, inside: impl Fn([f64; 3]) -> f64) -> Self {
        let mut kept = Self::NONE;
        for (k, &this) in self.corners().iter().enumerate() {
            let next = self.corners[(k + 1) % self.count];
            let (here, there) = (inside(this), inside(next));
            if here >= 0.0 {
                kept.push(this);
            }
            if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
                let part = here / (here - there);
                let mut cut = [0, 1, 2].map(|axis| this[axis] + part * (next[axis] - this[axis]));
                // Rounding must not lift a cut above its edge: the order of the search would show.
                cut[2] = cut[2].clamp(this[2].min(next[2]), this[2].max(next[2]));
                kept.push(cut);
            }
        }
        kept
    }

    /// Rounding can make a polygon so thin that it is cut once too often; its corners then lie on one
    /// another, and the last may be left out.
    fn push(&mut self, corner: [f64; 3]) {
        if self.count < self.corners.len() {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }
}
