//! A limit on the steps that a decoder may take for one tile, whatever its bytes are.

use std::cell::Cell;

use crate::payload::damage::Damage;

/// Steps done and allowed. Steps are counted and not timed, so that every machine refuses the same tiles.
#[derive(Debug)]
pub(crate) struct Work {
    limit: u64,
    done: Cell<u64>,
}

impl Work {
    pub(crate) fn new(limit: u64) -> Self {
        Self { limit, done: Cell::new(0) }
    }

    /// Counts `steps` more.
    pub(crate) fn add(&self, steps: usize) {
        self.done.set(self.done.get().saturating_add(steps as u64));
    }

    /// An error when more was done than is allowed.
    pub(crate) fn check(&self) -> Result<(), Damage> {
        if self.done.get() > self.limit {
            Err(Damage::TooMuchWork { limit: self.limit })
        } else {
            Ok(())
        }
    }

    /// Steps done.
    #[cfg(test)]
    pub(crate) fn done(&self) -> u64 {
        self.done.get()
    }
}

#[cfg(test)]
#[path = "work_limit_tests.rs"]
mod tests;
