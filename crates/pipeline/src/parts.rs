//! A build in parts: one step for one subtree by a process of its own, and the package from all parts.
//!
//! ```text
//!  plan ─┬─ hashes ──────────────────────────────────────┐
//!        ├─ roads ──────────────────────┐                │
//!        └─ heights of each subtree ─ top ─ tiles of each subtree ─ merge ─► package
//! ```
//!
//! Parts of one column may be made at once, in any order, on any machine that has the inputs at the paths of the plan. What is in the
//! stores already is not made again, so a part may be made twice.

mod merge;
mod part;
mod stores;

pub use merge::{MergeSettings, merge};
pub use part::{PartSettings, PartSummary, Step, make_part};

use self::stores::Stores;
use crate::{BuildError, BuildPlan, PlanSettings, Resources, context::MemoryShares, plan::Opened};

/// Opens the inputs of a plan and fails if they, or this program, are not those of the plan.
fn open(
    plan: &BuildPlan,
    generator: &str,
    resources: Resources,
) -> Result<(PlanSettings, Opened), BuildError> {
    let shares = MemoryShares::of(resources.memory_bytes);
    corniche_dem::limit_block_cache(shares.raster_cache)
        .map_err(|error| BuildError::Start { what: error.to_string() })?;
    let settings = PlanSettings { generator: generator.to_owned(), ..plan.settings()? };
    let opened = Opened::new(&settings)?;
    plan.check_same(&BuildPlan::of(&settings, &opened)?)?;
    Ok((settings, opened))
}
