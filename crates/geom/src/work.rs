//! A limit on the number of steps of a computation, whatever its input.

use std::cell::Cell;

/// The largest number of steps for draping lines on one tile, or for positioning its roads: each
/// examined triangle is a step, and a vertex where a line crosses an edge of the ground counts as
/// 32 steps.
///
/// Real tiles take some hundred thousand. The limit allows two million vertices, which take about
/// 500 MiB and a few seconds. It also limits the number of points in a file of lines.
pub const MOST_TILE_STEPS: u64 = 1 << 26;

/// More steps were taken than are allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("this takes more than the limit of {limit} steps")]
pub struct TooMuchWork {
    /// The number of allowed steps.
    pub limit: u64,
}

/// Steps done and allowed. Steps are counted, and time is not measured, so that every machine
/// rejects the same input.
#[derive(Debug)]
pub struct StepBudget {
    limit: u64,
    done: Cell<u64>,
}

impl StepBudget {
    /// Creates a budget of `limit` steps, none of them used.
    #[must_use]
    pub const fn new(limit: u64) -> Self {
        Self { limit, done: Cell::new(0) }
    }

    /// Creates a budget without a limit.
    #[must_use]
    pub const fn unlimited() -> Self {
        Self::new(u64::MAX)
    }

    /// Counts `steps` more steps.
    pub fn add(&self, steps: usize) {
        self.done.set(self.done.get().saturating_add(steps as u64));
    }

    /// Fails if more steps were done than are allowed.
    ///
    /// # Errors
    /// When the limit is exceeded.
    pub fn check(&self) -> Result<(), TooMuchWork> {
        if self.done.get() > self.limit { Err(TooMuchWork { limit: self.limit }) } else { Ok(()) }
    }

    /// The number of steps done.
    #[must_use]
    pub fn done(&self) -> u64 {
        self.done.get()
    }
}
