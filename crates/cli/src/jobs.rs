//! `corniche jobs`: the parts of a planned build, for a scheduler.

use std::io::{self, Write as _};

use corniche_pipeline::{Job, JobSettings};

use crate::{args::JobsArgs, exit::ExitCode, failure::Failure, part::read_plan, settings};

pub(crate) fn run(args: &JobsArgs) -> Result<ExitCode, Failure> {
    if let Some(seconds) = args.least_work.filter(|&seconds| !(0.0..=1e9).contains(&seconds)) {
        let message = format!("--least-work must be from 0 to 1e9 seconds, not {seconds}");
        return Err(Failure::unusable(message));
    }
    let jobs = corniche_pipeline::jobs(&JobSettings {
        plan: read_plan(&args.plan)?,
        stores: args.store.clone(),
        slots: args.slots,
        least_seconds: args.least_work,
        resources: settings::resources(None, None)?,
        generator: settings::generator(),
    })?;
    print(&jobs)
}

/// Prints one JSON object per line.
pub(crate) fn print(jobs: &[Job]) -> Result<ExitCode, Failure> {
    let mut out = io::stdout().lock();
    for job in jobs {
        let line =
            serde_json::to_string(job).map_err(|error| Failure::new(ExitCode::Failed, error))?;
        writeln!(out, "{line}")?;
    }
    Ok(ExitCode::Done)
}
