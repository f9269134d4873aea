//! The JSON document of `corniche plan`.

use corniche_plan::BuildEstimate;
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::EstimateDocument;

/// The estimates of a build.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct PlanDocument {
    /// Hash of the plan: equal plans produce equal packages.
    pub plan_sha256: String,
    /// The estimates.
    #[cfg_attr(test, schemars(with = "EstimateDocument"))]
    pub estimate: BuildEstimate,
}
