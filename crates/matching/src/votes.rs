//! The votes of all samples for each shift.

/// The shifts that are tried: a square of equal steps around zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ShiftSearch {
    /// Steps to each side.
    steps: i32,
    step_m: f64,
}

/// The most steps to each side: votes for each shift are kept for each road.
const MOST_STEPS: f64 = 20.0;

/// The offset of an image from roads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offset {
    /// The distance east that must be added to positions of the roads, metres.
    pub east_m: f64,
    /// The distance north that must be added to positions of the roads, metres.
    pub north_m: f64,
    /// The excess of the best shift's votes over the median, in multiples of the votes' scatter.
    /// From about 6, the image shows the offset clearly.
    pub confidence: f64,
    /// Whether the best shift is at the edge of those that were tried: the true one may be beyond.
    pub is_at_edge: bool,
}

/// The offset of an image from a road in one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlongOffset {
    /// The distance in that direction, metres.
    pub metres: f64,
    /// See [`Offset::confidence`].
    pub confidence: f64,
    /// See [`Offset::is_at_edge`].
    pub is_at_edge: bool,
}

impl ShiftSearch {
    /// Returns shifts up to `radius_m`, in steps of `step_m`, or in larger steps if there would be
    /// too many.
    pub(crate) fn new(radius_m: f64, step_m: f64) -> Self {
        let step_m = step_m.max(radius_m / MOST_STEPS);
        Self { steps: (radius_m / step_m).ceil() as i32, step_m }
    }

    /// East and north, metres: rows from the south, each from the west.
    pub(crate) fn shifts(&self) -> impl Iterator<Item = [f64; 2]> + use<> {
        let Self { steps, step_m } = *self;
        let all = move || (-steps..=steps).map(move |step| f64::from(step) * step_m);
        all().flat_map(move |north| all().map(move |east| [east, north]))
    }

    pub(crate) fn count(&self) -> usize {
        self.side() * self.side()
    }

    pub(crate) fn step_m(&self) -> f64 {
        self.step_m
    }

    /// The farthest shift along an axis.
    pub(crate) fn reach_m(&self) -> f64 {
        f64::from(self.steps) * self.step_m
    }

    fn side(&self) -> usize {
        (2 * self.steps + 1) as usize
    }
}

/// The sum of votes for each shift, and of the directions of the voting roads.
#[derive(Debug, Clone, Default)]
pub(crate) struct Votes {
    /// The sums in the order of [`ShiftSearch::shifts`]; empty before the first.
    sums: Vec<f32>,
    pub samples: u64,
    /// Sums of the products of the normals' components: east · east, east · north, north · north.
    normals: [f64; 3],
}

impl Votes {
    /// Adds the vote of a run of samples along a road: the size of their common response. A run
    /// that is partly darker and partly brighter is not a road.
    pub(crate) fn add(&mut self, answers: &[f32], samples: u64, normals: [f64; 3]) {
        if self.sums.is_empty() {
            self.sums = vec![0.0; answers.len()];
        }
        for (sum, answer) in self.sums.iter_mut().zip(answers) {
            *sum += answer.abs();
        }
        self.samples += samples;
        for (sum, own) in self.normals.iter_mut().zip(normals) {
            *sum += own;
        }
    }

    /// Returns the direction across which the roads determine the offset best, of length 1 and
    /// eastwards, and how much the roads bend away from it: 0 for one straight road, 1 for roads
    /// equally in all directions. A straight road does not determine the offset along itself.
    pub(crate) fn across(&self) -> ([f64; 2], f64) {
        let [ee, en, nn] = self.normals;
        let angle = 0.5 * (2.0 * en).atan2(ee - nn);
        let spread = ((ee - nn) / 2.0).hypot(en);
        let (most, least) = (f64::midpoint(ee, nn) + spread, f64::midpoint(ee, nn) - spread);
        let bends = if most > 0.0 { least.max(0.0) / most } else { 0.0 };
        ([angle.cos(), angle.sin()], bends)
    }

    /// Returns the offset for shifts in one direction alone, of length 1 and eastwards, with its
    /// confidence. For roads that are nearly straight, which do not determine the offset along
    /// themselves.
    pub(crate) fn offset_along(
        &self,
        [east, north]: [f64; 2],
        search: &ShiftSearch,
    ) -> Option<AlongOffset> {
        let sums: Option<Vec<f32>> = (-search.steps..=search.steps)
            .map(|step| self.between(f64::from(step) * east, f64::from(step) * north, search))
            .collect();
        let sums = sums?;
        let best = (0..sums.len()).max_by(|&a, &b| sums[a].total_cmp(&sums[b]))?;
        let confidence = confidence(&sums, best)?;
        let is_at_edge = best == 0 || best + 1 == sums.len();
        let part = match sums[..] {
            _ if is_at_edge => 0.0,
            _ => top([-1_i32, 0, 1]
                .map(|step| f64::from(sums[best.saturating_add_signed(step as isize)]))),
        };
        let metres = (best as f64 - f64::from(search.steps) + part) * search.step_m;
        Some(AlongOffset { metres, confidence, is_at_edge })
    }

    /// Interpolates the votes at a shift between steps, given in steps from zero.
    fn between(&self, east: f64, north: f64, search: &ShiftSearch) -> Option<f32> {
        let side = search.side();
        let [x, y] = [east, north].map(|at| at + f64::from(search.steps));
        let [column, row] = [x, y].map(|at| (at.floor() as usize).min(side - 2));
        let [fx, fy] = [x - column as f64, y - row as f64].map(|share| share as f32);
        let at = row * side + column;
        let sum = |at: usize| self.sums.get(at).copied();
        let mix = |a: f32, b: f32, share: f32| a + (b - a) * share;
        let south = mix(sum(at)?, sum(at + 1)?, fx);
        let north = mix(sum(at + side)?, sum(at + side + 1)?, fx);
        Some(mix(south, north, fy))
    }

    /// Returns the shift with most votes, to a fraction of a step. `None` without votes, or if all
    /// shifts have the same.
    pub(crate) fn offset(&self, search: &ShiftSearch) -> Option<Offset> {
        let side = search.side();
        let best = (0..self.sums.len()).max_by(|&a, &b| self.sums[a].total_cmp(&self.sums[b]))?;
        let confidence = confidence(&self.sums, best)?;
        let (column, row) = (best % side, best / side);
        let is_at_edge = [column, row].iter().any(|&at| at == 0 || at + 1 == side);
        let [east, north] = if is_at_edge {
            [0.0; 2]
        } else {
            let sum = |at: usize| f64::from(self.sums[at]);
            [1, side].map(|stride| top([sum(best - stride), sum(best), sum(best + stride)]))
        };
        let metres =
            |at: usize, part: f64| (at as f64 - f64::from(search.steps) + part) * search.step_m;
        Some(Offset {
            east_m: metres(column, east),
            north_m: metres(row, north),
            confidence,
            is_at_edge,
        })
    }
}

/// Returns the excess of the best sum over the median, in multiples of the sums' scatter; `None` if
/// they do not scatter.
///
/// The scatter is computed from the sums below the median: those above include the ridges along
/// which straight roads match as well.
fn confidence(sums: &[f32], best: usize) -> Option<f64> {
    let mut sorted = sums.to_vec();
    sorted.sort_unstable_by(f32::total_cmp);
    let at = |share: usize| sorted.get(sorted.len() / share).copied();
    let (low, median) = (at(10)?, at(2)?);
    // In a normal distribution, a tenth is more than 1.28 standard deviations below the median.
    let scatter = (median - low) / 1.28;
    (scatter > 0.0).then(|| f64::from((sums[best] - median) / scatter))
}

/// Returns the position of the maximum of the parabola through values at −1, 0 and 1, if the value
/// at 0 is the largest.
fn top([before, at, after]: [f64; 3]) -> f64 {
    let bend = before + after - 2.0 * at;
    if bend < 0.0 { ((before - after) / (2.0 * bend)).clamp(-0.5, 0.5) } else { 0.0 }
}

#[cfg(test)]
#[path = "votes_tests.rs"]
mod tests;
