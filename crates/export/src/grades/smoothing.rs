//! The smooth line through heights at even distances.
//!
//! Among all lines z, it minimises Σ h (z − g)² + (Lc / 2π)⁴ Σ h (z″)², where g are
//! the heights, h is the distance between stations, and z″ is the second difference over h².
//! Straight lines are unchanged; a sine of wavelength Lc keeps half of its amplitude, shorter ones
//! keep less. Source: Whittaker 1922, *On a New Method of Graduation*, with the penalty on second
//! differences; Reinsch 1967, *Smoothing by Spline Functions*.

use std::f64::consts::TAU;

use corniche_geom::GridFrame;

/// The largest distance between stations, metres.
pub(crate) const MOST_SPACING_M: f64 = 10.0;

/// The strength of the smoothing.
#[derive(Clone, Copy)]
pub(crate) struct Smoothing {
    /// The length of waves that keep half of their amplitude, metres.
    pub(crate) length_m: f64,
}

impl Smoothing {
    /// The smoothing for an elevation model with cells of this length: 4.5 cells, but at least 100
    /// m and at most 400 m.
    fn of_cell(cell_m: f64) -> Self {
        Self { length_m: (4.5 * cell_m).clamp(100.0, 400.0) }
    }

    /// The smoothing for the grid of a package.
    pub(crate) fn of_frame(frame: &GridFrame) -> Self {
        let [east_m, north_m] = frame.cell().to_array();
        Self::of_cell(east_m.max(north_m))
    }

    /// Returns the smooth line through heights at this spacing. Ends with a given height are fixed;
    /// others are free.
    pub(crate) fn solve(
        self,
        spacing_m: f64,
        heights_m: &[f64],
        held_m: [Option<f64>; 2],
    ) -> Vec<f64> {
        let mut system = System::new(heights_m.len(), self.stiffness(spacing_m));
        let mut right = heights_m.to_vec();
        let last = heights_m.len().saturating_sub(1);
        for (at, held_m) in [(0, held_m[0]), (last, held_m[1])] {
            if let Some(height_m) = held_m {
                system.hold(at, height_m, &mut right);
            }
        }
        system.factor();
        system.solve(&mut right);
        right
    }

    /// Returns the smooth line through heights around a ring: the last station is next to the
    /// first.
    pub(crate) fn solve_ring(self, spacing_m: f64, heights_m: &[f64]) -> Vec<f64> {
        let count = heights_m.len();
        // The influence of the free ends vanishes over this distance.
        let reach = (2.0 * self.length_m / spacing_m).ceil() as usize;
        let first = count - reach % count;
        let around: Vec<f64> =
            (0..count + 2 * reach).map(|k| heights_m[(first + k) % count]).collect();
        self.solve(spacing_m, &around, [None, None])[reach..reach + count].to_vec()
    }

    /// Returns the height of the free smooth line at one station, with its weight: the increase of
    /// the sum for another height there, divided by the square of the difference.
    pub(crate) fn estimate(self, spacing_m: f64, heights_m: &[f64], at: usize) -> WeightedHeight {
        let mut system = System::new(heights_m.len(), self.stiffness(spacing_m));
        system.factor();
        let mut smooth_m = heights_m.to_vec();
        system.solve(&mut smooth_m);
        let mut influence = vec![0.0; heights_m.len()];
        influence[at] = 1.0;
        system.solve(&mut influence);
        WeightedHeight { height_m: smooth_m[at], weight: spacing_m / influence[at] }
    }

    /// The weight of squared second differences relative to squared distances.
    fn stiffness(self, spacing_m: f64) -> f64 {
        if spacing_m > 0.0 { (self.length_m / TAU / spacing_m).powi(4) } else { 0.0 }
    }
}

/// A height with its weight.
#[derive(Clone, Copy)]
pub(crate) struct WeightedHeight {
    pub(crate) height_m: f64,
    pub(crate) weight: f64,
}

/// A symmetric matrix with two bands next to its diagonal; factored, L D Lᵀ.
struct System {
    diagonal: Vec<f64>,
    /// Entry k couples stations k and k + 1.
    next: Vec<f64>,
    /// Entry k couples stations k and k + 2.
    after_next: Vec<f64>,
}

impl System {
    /// Returns the identity plus `stiffness` times the sum of squared second differences.
    fn new(stations: usize, stiffness: f64) -> Self {
        let mut system = Self {
            diagonal: vec![1.0; stations],
            next: vec![0.0; stations],
            after_next: vec![0.0; stations],
        };
        for middle in 1..stations.saturating_sub(1) {
            for (at, factor) in [(middle - 1, 1.0), (middle, 4.0), (middle + 1, 1.0)] {
                system.diagonal[at] += factor * stiffness;
            }
            system.next[middle - 1] -= 2.0 * stiffness;
            system.next[middle] -= 2.0 * stiffness;
            system.after_next[middle - 1] += stiffness;
        }
        system
    }

    /// Fixes the value at an end.
    fn hold(&mut self, at: usize, value: f64, right: &mut [f64]) {
        let stations = self.diagonal.len();
        self.diagonal[at] = 1.0;
        right[at] = value;
        let mut uncouple = |band: &mut Vec<f64>, reach: usize| {
            if at + reach < stations {
                right[at + reach] -= std::mem::take(&mut band[at]) * value;
            }
            if let Some(before) = at.checked_sub(reach) {
                right[before] -= std::mem::take(&mut band[before]) * value;
            }
        };
        uncouple(&mut self.next, 1);
        uncouple(&mut self.after_next, 2);
        right[at] = value;
    }

    fn factor(&mut self) {
        let stations = self.diagonal.len();
        for k in 0..stations {
            let pivot = self.diagonal[k];
            let [one, two] = [self.next[k] / pivot, self.after_next[k] / pivot];
            if k + 1 < stations {
                self.diagonal[k + 1] -= one * self.next[k];
                self.next[k + 1] -= one * self.after_next[k];
            }
            if k + 2 < stations {
                self.diagonal[k + 2] -= two * self.after_next[k];
            }
            (self.next[k], self.after_next[k]) = (one, two);
        }
    }

    /// Replaces a right-hand side by the solution; requires [`System::factor`].
    fn solve(&self, right: &mut [f64]) {
        let stations = right.len();
        for k in 0..stations {
            let own = right[k];
            if k + 1 < stations {
                right[k + 1] -= self.next[k] * own;
            }
            if k + 2 < stations {
                right[k + 2] -= self.after_next[k] * own;
            }
        }
        for (value, pivot) in right.iter_mut().zip(&self.diagonal) {
            *value /= pivot;
        }
        for k in (0..stations).rev() {
            let next = right.get(k + 1).map_or(0.0, |next| self.next[k] * next);
            let after_next = right.get(k + 2).map_or(0.0, |next| self.after_next[k] * next);
            right[k] -= next + after_next;
        }
    }
}

#[cfg(test)]
#[path = "smoothing_tests.rs"]
mod tests;
