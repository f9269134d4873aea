//! What a build is going to make, and what it will need for it, before the work begins.
//!
//! ```text
//!   settings ─► Opened ─┬─► BuildPlan: what every worker must know, with a hash
//!                       └─► Estimate ─► Room: can it succeed here?
//! ```

mod build_plan;
mod coordinates;
mod covered_tiles;
mod differences;
mod enough_room;
mod error;
mod estimate;
mod facts;
mod opened_inputs;
pub mod rates;

use std::path::Path;

use corniche_spec::{Observer, PlanSettings, Resources, memory_shares::MemoryShares};

pub use build_plan::{BuildPlan, FrcTableRecord, PlannedGrid, PlannedLevel};
pub use error::{PLAN_VERSION, PlanError, PlanFileError};
pub use estimate::{Estimate, MemoryEstimate, Rates};
pub use facts::network_differences;
pub use opened_inputs::Opened;

/// Plans a build and estimates what it will take. Of many data some tiles are read for it.
///
/// # Errors
/// When a file cannot be used, the files make no grid, or a setting does not fit them.
pub fn plan(
    settings: &PlanSettings,
    resources: Resources,
    observer: &dyn Observer,
) -> Result<(BuildPlan, Estimate), PlanError> {
    MemoryShares::limit_raster_cache(resources)?;
    let opened = Opened::new(settings)?;
    let estimate = Estimate::of(&opened, resources, observer)?;
    Ok((BuildPlan::of(settings, &opened)?, estimate))
}

/// Fails if memory or disk space cannot suffice. Intermediate results go to the first folder, where they take `held_bytes` already; the
/// package goes to the second.
///
/// # Errors
/// See [`PlanError`].
pub fn check_room(
    opened: &Opened,
    resources: Resources,
    folders: [&Path; 2],
    held_bytes: u64,
    observer: &dyn Observer,
) -> Result<(), PlanError> {
    let estimate = Estimate::of(opened, resources, observer)?;
    enough_room::Room::of(resources.memory_bytes, folders, held_bytes)?.check(&estimate)
}
