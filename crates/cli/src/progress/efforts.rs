//! The efforts of the steps of a stage, where they are unequal.

/// Parts of an effort of 1: efforts are counted in whole numbers.
const PARTS: f64 = 16.0;

/// Runs of equal steps, one after the other: the number of steps, and the effort of each.
#[derive(Debug, Clone)]
pub(crate) struct Efforts(pub Vec<(u64, f64)>);

impl Efforts {
    /// The effort of the first `done` steps of `total`. If the total is smaller than expected,
    /// steps after the first run are skipped.
    pub(crate) fn until(&self, done: u64, total: Option<u64>) -> u64 {
        let expected: u64 = self.0.iter().map(|(steps, _)| steps).sum();
        let first = self.0.first().map_or(0, |(steps, _)| *steps);
        let left_out = expected.saturating_sub(total.unwrap_or(expected));
        let mut rest = if done > first { done + left_out } else { done };
        let mut effort = 0.0;
        for &(steps, each) in &self.0 {
            let own = rest.min(steps);
            effort += own as f64 * each;
            rest -= own;
        }
        (effort * PARTS) as u64
    }

    /// The effort of the remaining steps.
    pub(crate) fn after(&self, done: u64, total: Option<u64>) -> u64 {
        self.until(u64::MAX / 2, None).saturating_sub(self.until(done, total))
    }
}

#[cfg(test)]
#[path = "efforts_tests.rs"]
mod tests;
