//! How much a run of the tests looks at: after each change, in CI, or everything.

use std::env;

use crate::skip;

/// How many cases the tests look at, as `CORNICHE_TIER` says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tier {
    /// After each change: `scripts/test`.
    Quick,
    /// Before a change lands: `scripts/test ci`.
    Ci,
    /// Now and then: `scripts/test full`.
    Full,
}

impl Tier {
    /// The tier of this run; quick without `CORNICHE_TIER`.
    ///
    /// # Panics
    /// When the variable names no tier.
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

/// The number of cases for the tier of this run.
#[must_use]
pub fn cases<T>(quick: T, ci: T, full: T) -> T {
    match Tier::of_this_run() {
        Tier::Quick => quick,
        Tier::Ci => ci,
        Tier::Full => full,
    }
}

/// Each so many-th of some cases: `every` is for the quick tier, for CI and for full. `CORNICHE_TURN`, a number, says with which to
/// begin, so that runs of CI on different days look at different ones.
///
/// # Panics
/// When the variable is no number.
pub fn some_of<I: IntoIterator>(
    cases_of_all: I,
    every: [usize; 3],
) -> impl Iterator<Item = I::Item> {
    let [quick, ci, full] = every;
    let step = cases(quick, ci, full);
    let turn: usize = env::var("CORNICHE_TURN").map_or(0, |turn| turn.parse().expect("a number"));
    cases_of_all.into_iter().skip(turn % step).step_by(step)
}

/// Whether this run looks at everything; where it does not, the test that asks is skipped. `reason` says what it takes.
#[must_use]
pub fn is_full(reason: &str) -> bool {
    let is_full = Tier::of_this_run() == Tier::Full;
    if !is_full {
        skip(&format!("only in scripts/test full: {reason}"));
    }
    is_full
}
