//! Errors of reading a plan and of using it on another machine.

use corniche_roads::FrcTableError;

/// Version of a plan's JSON; other versions are refused.
pub const PLAN_VERSION: u32 = 8;

/// Why a text is no plan, or a plan cannot be used here.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum PlanError {
    #[error("this is no plan of a build: make one with corniche plan -o FILE")]
    Json(#[from] serde_json::Error),
    #[error(
        "the plan is of version {found}, and this program reads version {PLAN_VERSION}; make the plan again with this program: corniche plan -o FILE"
    )]
    Version { found: u32 },
    #[error("the plan's FRC table makes no sense; make the plan again")]
    FrcTable(#[from] FrcTableError),
    #[error(
        "the plan says on which levels classes of roads are shown, and this makes no sense; make the plan again"
    )]
    Filter,
    #[error("the plan's table of areas makes no sense; make the plan again")]
    AreaTable(#[from] corniche_areas::AreaTableError),
    #[error("the plan's table of areas names a class that does not exist; make the plan again")]
    AreaClass,
    #[error(transparent)]
    Polygon(#[from] corniche_gis::PolygonError),
    #[error(
        "the plan does not fit this machine or its files any more: {}; make the plan again, or use the files and the program that it was made with",
        differences.join("; ")
    )]
    Differs { differences: Vec<String> },
}
