//! What a build is going to make, and what it will need for it, before the work begins.

mod build_plan;
mod coordinates;
mod differences;
mod opened;

pub use build_plan::{BuildPlan, FrcTableRecord, PlanError, PlannedGrid, PlannedLevel};
pub(crate) use opened::Opened;
