//! What a plan is about, opened and compared with the plan.

use corniche_plan::{BuildPlan, Opened};
use corniche_spec::{PlanSettings, Resources, memory_shares::MemoryShares};

use crate::BuildError;

/// Opens the inputs of a plan and fails if they, or this program, are not those of the plan.
pub(crate) fn open(
    plan: &BuildPlan,
    generator: &str,
    resources: Resources,
) -> Result<(PlanSettings, Opened), BuildError> {
    MemoryShares::limit_raster_cache(resources)?;
    let settings = PlanSettings { generator: generator.to_owned(), ..plan.settings()? };
    let opened = Opened::new(&settings)?;
    plan.check_same(&BuildPlan::of(&settings, &opened)?)?;
    Ok((settings, opened))
}
