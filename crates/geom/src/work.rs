//! A limit on the steps that something may take, whatever the numbers are that it is given.

use std::cell::Cell;

/// Steps that laying lines on one tile, or placing its roads, may take: looking at a triangle is one, and a vertex where a line crosses an edge
/// of the ground counts for 32.
///
/// Real tiles take some hundred thousand. The limit is two million vertices, some 500 MiB of them, and a few seconds. How many points a file
/// of lines may have follows from it.
pub const MOST_TILE_STEPS: u64 = 1 << 26;

/// More steps were taken than are allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("it takes more than the limit of {limit} steps")]
pub struct TooMuchWork {
    /// How many are allowed.
    pub limit: u64,
}

/// Steps done and allowed. Steps are counted and not timed, so that every machine refuses the same.
#[derive(Debug)]
pub struct Work {
    limit: u64,
    done: Cell<u64>,
}

impl Work {
    /// Nothing is done yet of at most so many steps.
    #[must_use]
    pub const fn new(limit: u64) -> Self {
        Self { limit, done: Cell::new(0) }
    }

    /// Work that is never too much.
    #[must_use]
    pub const fn unlimited() -> Self {
        Self::new(u64::MAX)
    }

    /// Counts `steps` more.
    pub fn add(&self, steps: usize) {
        self.done.set(self.done.get().saturating_add(steps as u64));
    }

    /// An error when more was done than is allowed.
    ///
    /// # Errors
    /// When the limit is passed.
    pub fn check(&self) -> Result<(), TooMuchWork> {
        if self.done.get() > self.limit { Err(TooMuchWork { limit: self.limit }) } else { Ok(()) }
    }

    /// Steps done.
    #[must_use]
    pub fn done(&self) -> u64 {
        self.done.get()
    }
}
