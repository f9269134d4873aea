//! A decoder that takes more steps for one tile than are allowed says that the tile is damaged.

pub(crate) use corniche_geom::Work;

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
