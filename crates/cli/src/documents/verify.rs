//! The JSON document of `corniche verify`.

use corniche_tileset::SampleErrorRecord;
use corniche_verify::{ErrorFigures, GapFigures, VerifyReport};
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::{ErrorDocument, GapDocument, SamplesDocument};

/// Whether a package keeps its promises.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct VerifyDocument {
    /// No check is broken.
    holds: bool,
    /// Tiles looked at.
    tiles: u64,
    /// Borders between tiles of one level that were compared.
    borders: u64,
    /// The checks.
    checks: Vec<CheckDocument>,
    /// Gaps between GEO roads and TINs, per level.
    #[cfg_attr(test, schemars(with = "Vec<GapDocument>"))]
    gaps: Vec<GapFigures>,
    /// With `--dem`: geometric errors, per level.
    #[cfg_attr(test, schemars(with = "Vec<ErrorDocument>"))]
    errors: Vec<ErrorFigures>,
    /// With `--dem`: how far the finest level is from the DEM's own samples.
    #[cfg_attr(test, schemars(with = "Option<SamplesDocument>"))]
    samples: Option<SampleErrorRecord>,
}

/// A check.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct CheckDocument {
    /// Its name, which does not change.
    id: &'static str,
    /// What it checks.
    promise: &'static str,
    /// Whether it holds; null when there was nothing to check.
    holds: Option<bool>,
    /// How many things were looked at.
    checked: u64,
    /// How many of them break it.
    broken: u64,
    /// The first few of those, in words.
    examples: Vec<String>,
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
