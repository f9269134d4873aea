//! `corniche part`: runs one step of a planned build, for one subtree.

use std::{fs, path::Path};

use corniche_objects::StorageRequests;
use corniche_pipeline::PartSettings;
use corniche_plan::BuildPlan;

use crate::{
    args::{PartArgs, plan_and_stores},
    exit::ExitCode,
    failure::{CommandFailure, Result},
    messages,
    presets::refuse_stream,
    progress::Progress,
    settings,
    table::bytes,
};

pub(crate) fn run(args: &PartArgs) -> Result<()> {
    let planned = &args.planned;
    let (plan, stores) = plan_and_stores(planned.plan.as_ref(), &planned.store)?;
    make_tmp(planned.tmp.as_deref())?;
    let part = PartSettings {
        plan: read_plan(&plan)?,
        stores,
        tmp: planned.tmp.clone(),
        step: args.step,
        subtree: args.subtree,
        share: args.share,
        resources: settings::resources(planned.cpu.threads, planned.memory.as_deref())?,
        generator: settings::generator(),
    };
    let progress = Progress::new();
    let made = corniche_pipeline::make_part(&part, &progress)?;
    match made.sealed {
        // Programs read the path (`path=$(corniche part …)`).
        Some(path) => {
            messages::answer_as_it_is(&[path.as_os_str().as_encoded_bytes(), b"\n"].concat())?;
        }
        None => messages::note("nothing to do: this part has no data, or is already in the stores"),
    }
    progress.tell_costs();
    if let Some(requests) = made.requests {
        messages::note(&told(&requests));
    }
    Ok(())
}

/// Creates the folder of `--tmp`, so that a new machine needs no preparation.
pub(crate) fn make_tmp(tmp: Option<&Path>) -> Result<()> {
    let Some(tmp) = tmp else { return Ok(()) };
    fs::create_dir_all(tmp).map_err(|error| {
        unusable!("cannot create the folder --tmp {tmp:?}; choose another one ({error})")
    })
}

/// The requests to object storage, which may cost money, as text.
pub(crate) fn told(requests: &StorageRequests) -> String {
    let counts: Vec<String> =
        requests.by_method.iter().map(|(method, count)| format!("{count} {method}")).collect();
    format!(
        "object storage: {}; {} received, {} sent",
        counts.join(", "),
        bytes(requests.received_bytes),
        bytes(requests.sent_bytes)
    )
}

/// Reads a plan from its file.
pub(crate) fn read_plan(path: &Path) -> Result<BuildPlan> {
    let text = refuse_stream(path)
        .and_then(|()| fs::read_to_string(path))
        .map_err(|error| unusable!("cannot read the plan {path:?}: {error}"))?;
    BuildPlan::from_json(&text)
        .map_err(|error| CommandFailure::new(ExitCode::Unusable, error).about(path))
}
