//! If a tile takes more steps to decode than are allowed, the decoder reports it as damaged.

pub(crate) use corniche_geom::StepBudget;

use corniche_geom::TooMuchWork;

use crate::payload::damage::Damage;

impl From<TooMuchWork> for Damage {
    fn from(TooMuchWork { limit }: TooMuchWork) -> Self {
        Self::TooMuchWork { limit }
    }
}

#[cfg(test)]
#[path = "work_limit_tests.rs"]
mod tests;
