//! `corniche build`: runs the pipeline.

use std::path::Path;

use corniche_pipeline::{BuildError, BuildSettings, BuildSummary, Existing, Leftovers};
use corniche_tileset::Manifest;

use crate::{
    args::{BuildArgs, ReportArgs},
    defects::{DefectList, Watch},
    exit::ExitCode,
    failure::Failure,
    info, output,
    settings::{self, Work},
};

pub(crate) fn run(args: Box<BuildArgs>) -> Result<ExitCode, Failure> {
    output::writable(&args.output)?;
    let report = args.report;
    let mut others: Vec<&Path> = args.work.files().collect();
    others.push(&args.output);
    let watch = Watch::new(report, args.defects.as_deref(), args.overwrite, &others)?;
    let settings = settings(*args)?;
    let built = corniche_pipeline::build(&settings, &watch);
    finish(built, watch, report, &settings.output)
}

/// Tells what became of a build, and puts the list of defects in its place.
pub(crate) fn finish(
    built: Result<BuildSummary, BuildError>,
    watch: Watch,
    report: ReportArgs,
    output: &Path,
) -> Result<ExitCode, Failure> {
    let is_json = report.json_progress;
    let quiet = report.quiet || is_json;
    // A list is put in its place only if it is complete. That is so after a run that failed because no road was kept: all
    // roads were looked at, and the list tells why they were lost.
    let is_complete = match &built {
        Ok(_) | Err(BuildError::NoRoads { .. } | BuildError::NoGround { .. }) => true,
        Err(_) => false,
    };
    let listed = watch.defects.filter(|_| is_complete).map_or(Ok(()), DefectList::finish);
    let summary = built?;
    listed?;
    if quiet {
        tell_warnings(&summary.manifest, is_json);
    } else {
        eprintln!("\n{}", info::to_text(&summary.manifest, summary.package_bytes));
        eprintln!("wrote {}", output.display());
    }
    watch.progress.tell_costs();
    Ok(ExitCode::Done)
}

/// Warnings are printed with `--quiet`, too.
fn tell_warnings(manifest: &Manifest, as_json: bool) {
    for warning in info::warnings(manifest) {
        if as_json {
            eprintln!("{}", serde_json::json!({ "warning": warning }));
        } else {
            eprintln!("corniche: warning: {warning}");
        }
    }
}

/// The settings of a build.
fn settings(args: BuildArgs) -> Result<BuildSettings, Failure> {
    let Work { plan, resources, tmp, force } = settings::of(args.work)?;
    Ok(BuildSettings {
        plan,
        output: args.output,
        existing: if args.overwrite { Existing::Replace } else { Existing::Keep },
        tmp,
        leftovers: match (args.resume, args.overwrite) {
            (true, _) => Leftovers::Resume,
            (false, true) => Leftovers::Discard,
            (false, false) => Leftovers::Refuse,
        },
        force,
        resources,
    })
}
