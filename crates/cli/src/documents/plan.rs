//! The JSON document of `corniche plan`.

use corniche_plan::Estimate;
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::EstimateDocument;

/// What a build will take.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct PlanDocument {
    /// The plan's hash: equal plans make equal packages.
    pub(crate) plan_sha256: String,
    /// The estimates.
    #[cfg_attr(test, schemars(with = "EstimateDocument"))]
    pub(crate) estimate: Estimate,
}
