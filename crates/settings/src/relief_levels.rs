//! Which levels of a package have relief sections.

use serde::{Deserialize, Serialize};

/// Which levels of a package have relief sections.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ReliefLevels {
    /// No level, as in packages of the first versions.
    #[default]
    Off,
    /// The finest level only.
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
