//! The plan of a build and the resources that it needs, before the work begins.
//!
//! ```text
//!   settings ─► Opened ─┬─► BuildPlan: what every worker must know, with a hash
//!                       └─► BuildEstimate ─► AvailableSpace: can it succeed here?
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

use corniche_spec::{BuildObserver, PlanSettings, Resources, memory_shares::MemoryShares};

pub use build_plan::{BuildPlan, FrcTableRecord, PlannedGrid, PlannedLevel};
pub use error::{PLAN_VERSION, PlanError, PlanFileError};
pub use estimate::{BuildEstimate, MemoryEstimate, Rates};
pub use facts::network_differences;
pub use opened_inputs::Opened;

/// Plans a build and estimates its cost. If there are many data, some of their tiles are read for
/// the estimate.
///
/// # Errors
/// When a file cannot be used, the files do not form a grid, or a setting does not match them.
pub fn plan(
    settings: &PlanSettings,
    resources: Resources,
    observer: &dyn BuildObserver,
) -> Result<(BuildPlan, BuildEstimate), PlanError> {
    MemoryShares::limit_raster_cache(resources)?;
    let opened = Opened::new(settings)?;
    let estimate = BuildEstimate::from_opened(&opened, resources, observer)?;
    Ok((BuildPlan::from_settings(settings, &opened)?, estimate))
}

/// Fails if memory or disk space are insufficient. Intermediate results are written to the first
/// folder, where they already occupy `held_bytes`; the package is written to the second folder.
///
/// # Errors
/// See [`PlanError`].
pub fn check_room(
    opened: &Opened,
    resources: Resources,
    folders: [&Path; 2],
    held_bytes: u64,
    observer: &dyn BuildObserver,
) -> Result<(), PlanError> {
    let estimate = BuildEstimate::from_opened(opened, resources, observer)?;
    enough_room::AvailableSpace::measure(resources.memory_bytes, folders, held_bytes)?
        .check(&estimate)
}
