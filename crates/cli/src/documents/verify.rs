//! The JSON document of `corniche verify`.

use corniche_pipeline::VerifyReport;
use corniche_tileset::{Distribution, SampleErrorRecord};
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::{DistributionDocument, SamplesDocument};

/// Whether a package keeps its promises.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct VerifyDocument {
    /// No check is broken.
    pub(crate) holds: bool,
    /// Tiles looked at.
    pub(crate) tiles: u64,
    /// Borders between tiles of one level that were compared.
    pub(crate) borders: u64,
    /// The checks.
    pub(crate) checks: Vec<CheckDocument>,
    /// Gaps between GEO roads and TINs, per level.
    pub(crate) gaps: Vec<GapDocument>,
    /// With `--dem`: geometric errors, per level.
    pub(crate) errors: Vec<ErrorDocument>,
    /// With `--dem`: how far the finest level is from the DEM's own samples.
    #[cfg_attr(test, schemars(with = "Option<SamplesDocument>"))]
    pub(crate) samples: Option<SampleErrorRecord>,
}

/// A check.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct CheckDocument {
    /// Its name, which does not change.
    pub(crate) id: &'static str,
    /// What it checks.
    pub(crate) promise: &'static str,
    /// Whether it holds; null when there was nothing to check.
    pub(crate) holds: Option<bool>,
    /// How many things were looked at.
    pub(crate) checked: u64,
    /// How many of them break it.
    pub(crate) broken: u64,
    /// The first few of those, in words.
    pub(crate) examples: Vec<String>,
}

/// Gaps of a level.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct GapDocument {
    /// Level.
    pub(crate) level: u8,
    /// Edges looked at.
    pub(crate) edges: u64,
    /// Largest gap, metres.
    pub(crate) largest_m: f64,
}

/// Errors of a level.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ErrorDocument {
    /// Level.
    pub(crate) level: u8,
    /// Tiles measured.
    pub(crate) tiles: u64,
    /// Nodes with data that were compared.
    pub(crate) nodes: u64,
    /// Largest distance of a TIN from a node, metres.
    pub(crate) largest_true_m: f64,
    /// Stored error over true error, for the tiles where that can be measured.
    #[cfg_attr(test, schemars(with = "Option<DistributionDocument>"))]
    pub(crate) tightness: Option<Distribution>,
    /// Nodes with data that the TINs do not cover.
    pub(crate) uncovered_nodes: u64,
}

impl From<&VerifyReport> for VerifyDocument {
    fn from(report: &VerifyReport) -> Self {
        let check = |check: &corniche_pipeline::Check| CheckDocument {
            id: check.id.id(),
            promise: check.id.promise(),
            holds: check.verdict(),
            checked: check.checked,
            broken: check.broken,
            examples: check.examples.clone(),
        };
        let gap = |gap: &corniche_pipeline::GapFigures| GapDocument {
            level: gap.level,
            edges: gap.edges,
            largest_m: gap.largest_m,
        };
        let error = |figures: &corniche_pipeline::ErrorFigures| ErrorDocument {
            level: figures.level,
            tiles: figures.tiles,
            nodes: figures.nodes,
            largest_true_m: figures.largest_true_m,
            tightness: figures.tightness,
            uncovered_nodes: figures.uncovered_nodes,
        };
        Self {
            holds: report.holds(),
            tiles: report.tiles,
            borders: report.borders,
            checks: report.checks.iter().map(check).collect(),
            gaps: report.gaps.iter().map(gap).collect(),
            errors: report.errors.iter().map(error).collect(),
            samples: report.samples,
        }
    }
}
