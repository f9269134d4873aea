//! `corniche merge`: merges the parts of a planned build into its package.

use std::path::Path;

use corniche_pipeline::{MergeSettings, is_in_object_storage};

use crate::{
    args::{MergeArgs, plan_and_stores},
    build,
    failure::Result,
    messages, names, output,
    part::{make_tmp, read_plan, told},
    progress::Progress,
    settings,
};

pub(crate) fn run(args: &MergeArgs) -> Result<()> {
    let planned = &args.planned;
    if !is_in_object_storage(&args.output) {
        output::writable(&args.output)?;
    }
    names::refuse_other_than_package(&args.output)?;
    let (plan_file, stores) = plan_and_stores(planned.plan.as_ref(), &planned.store)?;
    make_tmp(planned.tmp.as_deref())?;
    let plan = read_plan(&plan_file)?;
    let mut others: Vec<&Path> = plan.inputs.iter().map(|input| Path::new(&input.path)).collect();
    others.extend([args.output.as_path(), plan_file.as_path()]);
    let progress = Progress::of_build(args.defects.as_deref(), args.overwrite, &others)?;
    let merge = MergeSettings {
        plan,
        stores,
        tmp: planned.tmp.clone(),
        output: args.output.clone(),
        existing: output::existing_of(args.overwrite),
        resources: settings::resources(planned.cpu.threads, planned.memory.as_deref())?,
        generator: settings::generator(),
    };
    let merged = corniche_pipeline::merge(&merge, &progress);
    let (package, requests) = match merged {
        Ok(merged) => (Ok(merged.package), merged.requests),
        Err(error) => (Err(error), None),
    };
    build::finish(package, progress, &args.output)?;
    if let Some(requests) = requests {
        messages::note(&told(&requests));
    }
    Ok(())
}
