//! Which levels of a package have relief sections.

use serde::{Deserialize, Serialize};

corniche_roads::listed! {
    /// Which levels of a package have relief sections.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum ReliefLevels {
        /// No level, as in packages of the first versions.
        #[default]
        Off = "off",
        /// The finest level only.
        Finest = "finest",
        /// All levels.
        Full = "full",
    }
    /// Its name on the command line.
    pub fn name() -> &'static str;
}

impl ReliefLevels {
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
