//! The extent of a run of the tests: after each change, in CI, or complete.

use std::env;

use crate::skip;

/// The number of cases in a run of the tests, set by `CORNICHE_TIER`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tier {
    /// The run after each change: `scripts/test`.
    Quick,
    /// The run before a change is merged: `scripts/test ci`.
    Ci,
    /// The complete run, now and then: `scripts/test full`.
    Full,
}

impl Tier {
    /// Returns the tier of this run; quick without `CORNICHE_TIER`.
    ///
    /// # Panics
    /// When the variable is not the name of a tier.
    #[must_use]
    pub fn of_this_run() -> Self {
        match env::var("CORNICHE_TIER").as_deref() {
            Err(_) | Ok("quick") => Self::Quick,
            Ok("ci") => Self::Ci,
            Ok("full") => Self::Full,
            Ok(other) => panic!("CORNICHE_TIER is {other:?}; it is quick, ci or full"),
        }
    }
}

/// Returns the number of cases for the tier of this run.
#[must_use]
pub fn cases<T>(quick: T, ci: T, full: T) -> T {
    match Tier::of_this_run() {
        Tier::Quick => quick,
        Tier::Ci => ci,
        Tier::Full => full,
    }
}

/// Selects one in a number of cases: `every` has the numbers for the quick tier, for CI and for
/// full. `CORNICHE_TURN`, a number, sets the first case, so that CI runs on different days test
/// different cases.
///
/// # Panics
/// When the variable is not a number.
pub fn some_of<I: IntoIterator>(
    cases_of_all: I,
    every: [usize; 3],
) -> impl Iterator<Item = I::Item> {
    let [quick, ci, full] = every;
    let step = cases(quick, ci, full);
    let turn: usize = env::var("CORNICHE_TURN").map_or(0, |turn| turn.parse().expect("a number"));
    cases_of_all.into_iter().skip(turn % step).step_by(step)
}

/// Whether this run is complete; if it is not, the calling test is skipped. `reason` describes the
/// cost of the test.
#[must_use]
pub fn is_full(reason: &str) -> bool {
    let is_full = Tier::of_this_run() == Tier::Full;
    if !is_full {
        skip(&format!("only in scripts/test full: {reason}"));
    }
    is_full
}
