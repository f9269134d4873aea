//! The grey of an image between texels, and whether the image shows a line at a place.

use crate::{samples::RoadSample, votes::ShiftSearch};

/// Values at the centres of texels, row by row from the north; NaN where there is no data.
#[derive(Debug, Clone)]
pub(crate) struct Grey {
    /// The texel of the first value, eastwards and southwards.
    pub first: [i64; 2],
    pub columns: usize,
    pub values: Vec<f32>,
}

impl Grey {
    /// Interpolates the value at a place in texels, where the centre of texel (0, 0) is (0.5, 0.5),
    /// from the four centres around it. NaN if one of them has no value.
    pub(crate) fn at(&self, [u, v]: [f64; 2]) -> f32 {
        let (x, y) = (u - 0.5 - self.first[0] as f64, v - 0.5 - self.first[1] as f64);
        let (column, row) = (x.floor(), y.floor());
        let rows = self.values.len() / self.columns.max(1);
        let is_inside = column >= 0.0
            && row >= 0.0
            && column + 1.0 < self.columns as f64
            && row + 1.0 < rows as f64;
        if !is_inside {
            return f32::NAN;
        }
        let at = row as usize * self.columns + column as usize;
        let [fx, fy] = [(x - column) as f32, (y - row) as f32];
        let mix = |a: f32, b: f32, share: f32| a + (b - a) * share;
        let north = mix(self.values[at], self.values[at + 1], fx);
        let below = at + self.columns;
        let south = mix(self.values[below], self.values[below + 1], fx);
        mix(north, south, fy)
    }
}

/// The transformation from texels to working metres, eastwards and southwards.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TexelScale {
    /// The position of the outer corner of texel (0, 0).
    pub origin_m: [f64; 2],
    /// East and north.
    pub texel_m: [f64; 2],
}

impl TexelScale {
    pub(crate) fn texel_of(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x - self.origin_m[0]) / self.texel_m[0], (self.origin_m[1] - y) / self.texel_m[1]]
    }
}

/// The least distance from a road's edge at which the ground is sampled, metres.
const LEAST_BESIDE_M: f64 = 2.0;
/// Half the width of the widest road that is searched, metres; wider texels raise this limit.
const MOST_HALF_WIDTH_M: f64 = 15.0;

/// Half the width of a road, and the distance from its edges at which the ground is sampled,
/// metres.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RoadCrossSection {
    pub half_width_m: f64,
    pub beside_m: f64,
}

impl RoadCrossSection {
    /// Returns the cross-section of a road of this width in an image of texels of this size. The
    /// half width is at least half a texel.
    pub(crate) fn new(width_m: f64, texel_m: f64) -> Self {
        Self {
            half_width_m: (width_m / 2.0).min(MOST_HALF_WIDTH_M).max(texel_m / 2.0),
            beside_m: LEAST_BESIDE_M.max(texel_m),
        }
    }

    /// The largest distance from the middle of the road that is sampled.
    pub(crate) fn reach_m(&self) -> f64 {
        self.half_width_m + 2.0 * self.beside_m
    }
}

/// Returns how much brighter the middle is than both sides at each shift, in the order of
/// [`ShiftSearch::shifts`]: negative if it is darker, and 0 if its brightness is between those of
/// both sides, which indicates an edge rather than a line. `None` if a value is missing.
pub(crate) fn responses(
    grey: &Grey,
    scale: &TexelScale,
    sample: &RoadSample,
    profile: RoadCrossSection,
    search: &ShiftSearch,
) -> Option<Vec<f32>> {
    let [nx, ny] = sample.normal;
    let mut found = Vec::with_capacity(search.count());
    for [east, north] in search.shifts() {
        let value = |aside_m: f64| {
            let place = [sample.at[0] + east + nx * aside_m, sample.at[1] + north + ny * aside_m];
            grey.at(scale.texel_of(place))
        };
        let half = profile.half_width_m / 2.0;
        let middle = (value(-half) + value(0.0) + value(half)) / 3.0;
        let side = |sign: f64| {
            let near = profile.half_width_m + profile.beside_m;
            let far = profile.reach_m();
            f32::midpoint(value(sign * near), value(sign * far))
        };
        let [left, right] = [middle - side(1.0), middle - side(-1.0)];
        if left.is_nan() || right.is_nan() {
            return None;
        }
        let is_line = (left > 0.0) == (right > 0.0);
        let least = if left.abs() < right.abs() { left } else { right };
        found.push(if is_line { least.clamp(-MOST, MOST) } else { 0.0 });
    }
    Some(found)
}

/// The largest response: a single bright roof must not outvote a road.
const MOST: f32 = 40.0;

#[cfg(test)]
#[path = "response_tests.rs"]
mod tests;
