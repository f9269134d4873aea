//! The choice of levels that store rasters for shading.

use clap::ValueEnum;
use serde::Deserialize;

/// `--relief`: which levels store their rasters for shading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ReliefChoice {
    /// None
    Off,
    /// The finest level alone
    Finest,
    /// All levels
    Full,
}
