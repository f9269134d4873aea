//! A triangle of the ground, cut by straight lines.

use corniche_geom::along;

/// A convex polygon from a triangle that was cut by up to four lines: at most seven corners, stored
/// in place. A corner is [along, across, height].
#[derive(Clone, Copy)]
pub(crate) struct ConvexPolygon {
    corners: [[f64; 3]; 8],
    count: usize,
}

impl ConvexPolygon {
    pub(crate) const NONE: Self = Self { corners: [[0.0; 3]; 8], count: 0 };

    pub(crate) fn from_triangle([a, b, c]: [[f64; 3]; 3]) -> Self {
        let mut corners = [[0.0; 3]; 8];
        corners[..3].copy_from_slice(&[a, b, c]);
        Self { corners, count: 3 }
    }

    /// The corners in order around the polygon; empty if nothing is left.
    pub(crate) fn corners(&self) -> &[[f64; 3]] {
        &self.corners[..self.count]
    }

    /// The area in plan, in square steps.
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

    /// Returns the part in which `inside`, an affine function, is at least 0.
    pub(crate) fn cut(&self, inside: impl Fn([f64; 3]) -> f64) -> Self {
        let mut kept = Self::NONE;
        for (k, &this) in self.corners().iter().enumerate() {
            let next = self.corners[(k + 1) % self.count];
            let (here, there) = (inside(this), inside(next));
            if here >= 0.0 {
                kept.push(this);
            }
            if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
                let part = here / (here - there);
                let mut cut = along(this, next, part);
                // Rounding must not lift a cut above its edge: the result would then depend on the
                // order of the search.
                cut[2] = cut[2].clamp(this[2].min(next[2]), this[2].max(next[2]));
                kept.push(cut);
            }
        }
        kept
    }

    /// Because of rounding, a very thin polygon can have one more cut than is possible. Some
    /// corners then coincide, and the last one can be dropped.
    fn push(&mut self, corner: [f64; 3]) {
        if self.count < self.corners.len() {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }
}
