//! The JSON document of `corniche verify`.

use corniche_tileset::SampleErrorRecord;
use corniche_verify::{ErrorFigures, GapFigures, VerifyReport};
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::{ErrorDocument, GapDocument, SamplesDocument};

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
    #[cfg_attr(test, schemars(with = "Vec<GapDocument>"))]
    pub(crate) gaps: Vec<GapFigures>,
    /// With `--dem`: geometric errors, per level.
    #[cfg_attr(test, schemars(with = "Vec<ErrorDocument>"))]
    pub(crate) errors: Vec<ErrorFigures>,
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

impl From<&VerifyReport> for VerifyDocument {
    fn from(report: &VerifyReport) -> Self {
        let check = |check: &corniche_verify::Check| CheckDocument {
            id: check.id.id(),
            promise: check.id.promise(),
            holds: check.verdict(),
            checked: check.checked,
            broken: check.broken,
            examples: check.examples.clone(),
        };
        Self {
            holds: report.holds(),
            tiles: report.tiles,
            borders: report.borders,
            checks: report.checks.iter().map(check).collect(),
            gaps: report.gaps.clone(),
            errors: report.errors.clone(),
            samples: report.samples,
        }
    }
}
