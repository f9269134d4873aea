//! Which levels of a package have relief sections.

use serde::{Deserialize, Serialize};

/// Which levels of a package have relief sections.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ReliefLevels {
    /// None: packages of the first programs have none.
    #[default]
    Off,
    /// The finest level alone.
    Finest,
    /// All levels.
    Full,
}

impl ReliefLevels {
    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Finest => "finest",
            Self::Full => "full",
        }
    }

    /// Whether tiles of a level have a relief section.
    #[must_use]
    pub fn has(self, level: u8, finest_level: u8) -> bool {
        match self {
            Self::Off => false,
            Self::Finest => level == finest_level,
            Self::Full => true,
        }
    }
}
