//! The grey of an image between texels, and whether the image shows a line at a place.

use crate::{samples::Sample, votes::Search};

/// Values at the centres of texels, row by row from the north; NaN where there is none.
#[derive(Debug, Clone)]
pub(crate) struct Grey {
    /// Texel of the first value, eastwards and southwards.
    pub(crate) first: [i64; 2],
    pub(crate) columns: usize,
    pub(crate) values: Vec<f32>,
}

impl Grey {
    /// The value at a place in texels, where the centre of texel (0, 0) is (0.5, 0.5): from the
    /// four centres around it. NaN where one of them has none.
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

/// Texels to working metres, eastwards and southwards.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TexelScale {
    /// Where texel (0, 0) begins.
    pub(crate) origin_m: [f64; 2],
    /// East and north.
    pub(crate) texel_m: [f64; 2],
}

impl TexelScale {
    pub(crate) fn texel_of(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x - self.origin_m[0]) / self.texel_m[0], (self.origin_m[1] - y) / self.texel_m[1]]
    }
}

/// Least distance beside a road at which the ground is looked at, metres.
const LEAST_BESIDE_M: f64 = 2.0;
/// Half the width of the widest road that is looked for, but on texels that are wider, metres.
const MOST_HALF_WIDTH_M: f64 = 15.0;

/// Half the width of a road, and how far beside its edges the ground is looked at, metres.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Profile {
    pub(crate) half_width_m: f64,
    pub(crate) beside_m: f64,
}

impl Profile {
    /// The profile of a road so wide in an image of such texels, of which a half is the least that
    /// is looked at.
    pub(crate) fn new(width_m: f64, texel_m: f64) -> Self {
        Self {
            half_width_m: (width_m / 2.0).min(MOST_HALF_WIDTH_M).max(texel_m / 2.0),
            beside_m: LEAST_BESIDE_M.max(texel_m),
        }
    }

    /// How far from its middle it looks.
    pub(crate) fn reach_m(&self) -> f64 {
        self.half_width_m + 2.0 * self.beside_m
    }
}

/// How much brighter the middle is than both sides at each shift, in the order of
/// [`Search::shifts`]; negative where it is darker, 0 where it lies between both sides: there is an
/// edge and no line. `None` if a value is missing.
pub(crate) fn responses(
    grey: &Grey,
    scale: &TexelScale,
    sample: &Sample,
    profile: Profile,
    search: &Search,
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

/// A single bright roof must not outvote a road.
const MOST: f32 = 40.0;

#[cfg(test)]
#[path = "response_tests.rs"]
mod tests;
