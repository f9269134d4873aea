//! `corniche jobs`: lists the parts of a planned build, for a scheduler.

use corniche_pipeline::{Job, JobSettings};

use crate::{
    args::{JobsArgs, plan_and_stores},
    failure::{CommandFailure, Result},
    messages,
    part::read_plan,
    settings,
};

pub(crate) fn run(args: &JobsArgs) -> Result<()> {
    if let Some(seconds) = args.least_work.filter(|&seconds| !(0.0..=1e9).contains(&seconds)) {
        let message = format!("--least-work must be between 0 and 1e9 seconds, not {seconds}");
        return Err(CommandFailure::unusable(message));
    }
    let (plan, stores) = plan_and_stores(args.plan.as_ref(), &args.store)?;
    let jobs = corniche_pipeline::jobs(&JobSettings {
        plan: read_plan(&plan)?,
        stores,
        slots: args.slots,
        least_seconds: args.least_work,
        resources: settings::resources(None, None)?,
        generator: settings::generator(),
    })?;
    print(&jobs)
}

/// Prints one JSON object per line.
pub(crate) fn print(jobs: &[Job]) -> Result<()> {
    for job in jobs {
        messages::answer_document(job)?;
    }
    Ok(())
}
