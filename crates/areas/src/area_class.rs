//! The classes of areas, such as water or forest, with their numbers and names.

use serde::{Deserialize, Serialize};
use std::fmt;

/// What an area is on the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum AreaClass {
    /// The sea: what lies on the right of coastlines.
    Sea,
    /// Lakes, reservoirs, wide rivers.
    Water,
    /// Ice that stays.
    Glacier,
    /// Forest and wood.
    Forest,
    /// Meadows, pastures, farmland.
    Meadow,
    /// Places where people live and work.
    Settlement,
    /// Parks and gardens.
    Park,
    /// Bare rock and scree.
    Rock,
}

impl AreaClass {
    /// How many classes there are.
    pub const COUNT: usize = 8;

    /// All classes, in order of their numbers.
    pub const ALL: [Self; Self::COUNT] = [
        Self::Sea,
        Self::Water,
        Self::Glacier,
        Self::Forest,
        Self::Meadow,
        Self::Settlement,
        Self::Park,
        Self::Rock,
    ];

    /// The class with this number.
    #[must_use]
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }

    /// Its number, 0 to 7.
    #[must_use]
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// Its name in tables and styles.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sea => "sea",
            Self::Water => "water",
            Self::Glacier => "glacier",
            Self::Forest => "forest",
            Self::Meadow => "meadow",
            Self::Settlement => "settlement",
            Self::Park => "park",
            Self::Rock => "rock",
        }
    }

    /// The class with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|class| class.name() == name)
    }
}

impl fmt::Display for AreaClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
