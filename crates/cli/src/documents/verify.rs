//! The JSON document of `corniche verify`.

use corniche_tileset::SampleErrorRecord;
use corniche_verify::{ErrorFigures, GapFigures, VerifyReport};
use schemars::JsonSchema;
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::{ErrorDocument, GapDocument, SamplesDocument};

/// The result of checking a package.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct VerifyDocument {
    /// Whether no check failed.
    holds: bool,
    /// Number of tiles checked.
    tiles: u64,
    /// Number of compared borders between tiles of one level.
    borders: u64,
    /// The checks.
    checks: Vec<CheckDocument>,
    /// Gaps between roads drawn as geometry (GEO) and the terrain's triangles (TIN), per level.
    #[cfg_attr(test, schemars(with = "Vec<GapDocument>"))]
    gaps: Vec<GapFigures>,
    /// With `--dem`: geometric errors, per level.
    #[cfg_attr(test, schemars(with = "Vec<ErrorDocument>"))]
    errors: Vec<ErrorFigures>,
    /// With `--dem`: differences between the finest level and the DEM's own samples.
    #[cfg_attr(test, schemars(with = "Option<SamplesDocument>"))]
    samples: Option<SampleErrorRecord>,
}

/// The result of a check.
#[derive(Serialize, JsonSchema)]
struct CheckDocument {
    /// Id of the check, which never changes.
    id: &'static str,
    /// The promise that is checked.
    promise: &'static str,
    /// Whether the package fulfils the promise. If nothing was checked: null for a check that needs
    /// an input, true for a check of the package alone.
    holds: Option<bool>,
    /// Number of objects checked.
    checked: u64,
    /// Number of objects that break the promise.
    broken: u64,
    /// The first few of the broken objects, in words.
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
