//! Opens the inputs of a plan and compares them with it.

use corniche_plan::{BuildPlan, Opened};
use corniche_spec::{PlanSettings, Resources, memory_shares::MemoryShares};

use crate::BuildError;

/// Opens the inputs of a plan and fails if the inputs or this program do not match the plan.
pub(crate) fn open(
    plan: &BuildPlan,
    generator: &str,
    resources: Resources,
) -> Result<(PlanSettings, Opened), BuildError> {
    MemoryShares::limit_raster_cache(resources)?;
    let settings = PlanSettings { generator: generator.to_owned(), ..plan.settings()? };
    let opened = Opened::new(&settings)?;
    plan.check_same(&BuildPlan::from_settings(&settings, &opened)?)?;
    Ok((settings, opened))
}
