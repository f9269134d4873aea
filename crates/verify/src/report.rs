//! The report of `corniche verify`: the results of all checks.

use corniche_tileset::{Distribution, SampleErrorRecord};
use serde::Serialize;

use super::checks::Check;

/// How far GEO roads are from their TIN on one level.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct GapFigures {
    /// Level.
    pub level: u8,
    /// The number of checked edges.
    pub edges: u64,
    /// Largest gap.
    pub largest_m: f64,
}

/// Geometric errors and deviations of one level.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ErrorFigures {
    /// The level.
    pub level: u8,
    /// The number of measured tiles.
    pub tiles: u64,
    /// The number of compared nodes with data.
    pub nodes: u64,
    /// Largest deviation: distance of a TIN from a node.
    pub largest_true_m: f64,
    /// Geometric error divided by the largest deviation of the tile and its children, for the tiles
    /// where that can be measured.
    pub tightness: Option<Distribution>,
    /// Nodes with data that the TINs do not cover.
    pub uncovered_nodes: u64,
}

/// The result of a verification.
#[derive(Debug, Clone, PartialEq)]
pub struct VerifyReport {
    /// The number of checked tiles.
    pub tiles: u64,
    /// The results of the checks.
    pub checks: Vec<Check>,
    /// Gaps between GEO roads and TINs, per level.
    pub gaps: Vec<GapFigures>,
    /// The number of compared borders between tiles of one level.
    pub borders: u64,
    /// Geometric errors and deviations per level, if the DEM was given.
    pub errors: Vec<ErrorFigures>,
    /// The errors of the finest level at the DEM's own samples, if the DEM was given.
    pub samples: Option<SampleErrorRecord>,
}

impl VerifyReport {
    /// Whether no promise is broken.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.checks.iter().all(Check::holds)
    }
}
