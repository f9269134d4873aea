//! What all samples together say of each shift.

/// Shifts that are tried: a square of equal steps around no shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Search {
    /// Steps to each side.
    steps: i32,
    step_m: f64,
}

/// Steps to each side, at most: votes for each shift are kept for each road.
const MOST_STEPS: f64 = 20.0;

/// How far an image lies beside roads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offset {
    /// What must be added to places of the roads, metres.
    pub east_m: f64,
    /// The same northwards.
    pub north_m: f64,
    /// How many times the scatter of the votes the best shift stands above their median. From about
    /// 6 on it is one that the image shows.
    pub confidence: f64,
    /// Whether the best shift lies at the edge of those that were tried: the true one may lie
    /// beyond.
    pub is_at_edge: bool,
}

/// How far an image lies beside a road, in one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlongOffset {
    /// How far in that direction, metres.
    pub metres: f64,
    /// See [`Offset::confidence`].
    pub confidence: f64,
    /// See [`Offset::is_at_edge`].
    pub is_at_edge: bool,
}

impl Search {
    /// Shifts up to `radius_m`, in steps of `step_m` or larger ones, if there were too many.
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

/// The sum of votes for each shift, and of the directions of the roads that gave them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Votes {
    /// The sums in the order of [`Search::shifts`]; empty before the first.
    sums: Vec<f32>,
    pub(crate) samples: u64,
    /// Sums of the products of the normals' parts: east · east, east · north, north · north.
    normals: [f64; 3],
}

impl Votes {
    /// A run of samples along a road votes with the size of what all of them answer together: what
    /// is now darker and now brighter is no road.
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

    /// The direction across which the roads say most, of length 1 and eastwards, and how much the
    /// roads bend away from it: 0 for one straight road, 1 for roads in all directions alike. Along
    /// a straight road nothing can be said.
    pub(crate) fn across(&self) -> ([f64; 2], f64) {
        let [ee, en, nn] = self.normals;
        let angle = 0.5 * (2.0 * en).atan2(ee - nn);
        let spread = ((ee - nn) / 2.0).hypot(en);
        let (most, least) = (f64::midpoint(ee, nn) + spread, f64::midpoint(ee, nn) - spread);
        let bends = if most > 0.0 { least.max(0.0) / most } else { 0.0 };
        ([angle.cos(), angle.sin()], bends)
    }

    /// The same for shifts in one direction alone, of length 1 and eastwards: how far, and the
    /// confidence. For roads that are nearly straight, of which nothing is known along them.
    pub(crate) fn offset_along(
        &self,
        [east, north]: [f64; 2],
        search: &Search,
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

    /// The votes at a shift between steps, given in steps from none.
    fn between(&self, east: f64, north: f64, search: &Search) -> Option<f32> {
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

    /// The shift with most votes, to a part of a step. `None` without votes, or where all shifts
    /// have the same.
    pub(crate) fn offset(&self, search: &Search) -> Option<Offset> {
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

/// How many times the scatter of the sums the best one stands above their median; `None` where they
/// do not scatter.
///
/// The scatter is taken from the sums below the median: those above hold the ridges along which
/// straight roads fit, too.
fn confidence(sums: &[f32], best: usize) -> Option<f64> {
    let mut sorted = sums.to_vec();
    sorted.sort_unstable_by(f32::total_cmp);
    let at = |share: usize| sorted.get(sorted.len() / share).copied();
    let (low, median) = (at(10)?, at(2)?);
    // Of a normal distribution a tenth lies more than 1.28 standard deviations below the median.
    let scatter = (median - low) / 1.28;
    (scatter > 0.0).then(|| f64::from((sums[best] - median) / scatter))
}

/// Where the parabola through values at −1, 0 and 1 is largest, if that at 0 is.
fn top([before, at, after]: [f64; 3]) -> f64 {
    let bend = before + after - 2.0 * at;
    if bend < 0.0 { ((before - after) / (2.0 * bend)).clamp(-0.5, 0.5) } else { 0.0 }
}

#[cfg(test)]
#[path = "votes_tests.rs"]
mod tests;
