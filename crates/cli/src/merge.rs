//! `corniche merge`: the package of a planned build from its parts.

use std::path::{Path, PathBuf};

use corniche_pipeline::{Existing, MergeSettings};

use crate::{
    args::MergeArgs,
    build,
    defects::{DefectList, Watch},
    exit::ExitCode,
    failure::Failure,
    output,
    part::read_plan,
    progress::Progress,
    settings,
};

pub(crate) fn run(args: &MergeArgs) -> Result<ExitCode, Failure> {
    let planned = &args.planned;
    output::writable(&args.output)?;
    let plan = read_plan(&planned.plan)?;
    let progress = Progress::new(&planned.report);
    let defects = match &args.defects {
        Some(path) => {
            let existing =
                if args.overwrite { output::Existing::Replace } else { output::Existing::Keep };
            let inputs: Vec<PathBuf> =
                plan.inputs.iter().map(|input| PathBuf::from(&input.path)).collect();
            let mut others: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
            others.extend([args.output.as_path(), planned.plan.as_path()]);
            Some(DefectList::create(path, existing, &others)?)
        }
        None => None,
    };
    let watch = Watch { progress, defects };
    let merge = MergeSettings {
        plan,
        stores: planned.store.clone(),
        output: args.output.clone(),
        existing: if args.overwrite { Existing::Replace } else { Existing::Keep },
        resources: settings::resources(planned.threads, planned.memory.as_deref())?,
        generator: settings::generator(),
    };
    let merged = corniche_pipeline::merge(&merge, &watch);
    build::finish(merged, watch, &planned.report, &args.output)
}
