//! The report of `corniche verify`: what each check found.

use corniche_tileset::{Distribution, SampleErrorRecord};
use serde::Serialize;

use super::checks::Check;

/// How far GEO roads are from their TIN on one level.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct GapFigures {
    /// Level.
    pub level: u8,
    /// Edges looked at.
    pub edges: u64,
    /// Largest gap.
    pub largest_m: f64,
}

/// Geometric errors and deviations of one level.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ErrorFigures {
    /// Level.
    pub level: u8,
    /// Tiles measured.
    pub tiles: u64,
    /// Nodes with data that were compared.
    pub nodes: u64,
    /// Largest deviation: distance of a TIN from a node.
    pub largest_true_m: f64,
    /// Geometric error divided by the largest deviation of the tile and its children, for the tiles where that can be
    /// measured.
    pub tightness: Option<Distribution>,
    /// Nodes with data that the TINs do not cover.
    pub uncovered_nodes: u64,
}

/// What verification found.
#[derive(Debug, Clone, PartialEq)]
pub struct VerifyReport {
    /// Tiles looked at.
    pub tiles: u64,
    /// The checks that were made.
    pub checks: Vec<Check>,
    /// Gaps between GEO roads and TINs, per level.
    pub gaps: Vec<GapFigures>,
    /// Borders between tiles of one level that were compared.
    pub borders: u64,
    /// Geometric errors and deviations per level, where the DEM was given.
    pub errors: Vec<ErrorFigures>,
    /// How far the finest level is from the DEM's own samples, where the DEM was given.
    pub samples: Option<SampleErrorRecord>,
}

impl VerifyReport {
    /// Whether every promise holds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.checks.iter().all(Check::holds)
    }
}
