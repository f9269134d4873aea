//! `corniche build`: runs the pipeline.

use std::{io, path::Path};

use corniche_pipeline::{BuildError, BuildSettings, BuildSummary, Existing, Leftovers};

use crate::{
    args::BuildArgs,
    defects::{DefectList, Watch},
    exit::ExitCode,
    failure::Failure,
    info, messages, output,
    settings::{self, Work},
    table::Digits,
};

pub(crate) fn run(args: Box<BuildArgs>) -> Result<ExitCode, Failure> {
    output::writable_package(&args.output)?;
    let mut others: Vec<&Path> = args.work.files().collect();
    others.push(&args.output);
    let watch = Watch::new(args.defects.as_deref(), args.overwrite, &others)?;
    let settings = settings(*args)?;
    let built = corniche_pipeline::build(&settings, &watch);
    finish(built, watch, &settings.output)
}

/// Tells what became of a build, and puts the list of defects in its place.
pub(crate) fn finish(
    built: Result<BuildSummary, BuildError>,
    watch: Watch,
    output: &Path,
) -> Result<ExitCode, Failure> {
    // A list is put in its place only if it is complete. That is so after a run that failed because no road was kept: all
    // roads were looked at, and the list tells why they were lost.
    let is_complete = match &built {
        Ok(_) | Err(BuildError::NoRoads { .. } | BuildError::NoGround { .. }) => true,
        Err(_) => false,
    };
    let listed = watch.defects.filter(|_| is_complete).map_or(Ok(()), DefectList::finish);
    let summary = built?;
    listed?;
    if messages::is_for_people() {
        let digits = Digits::on(&io::stderr());
        let text = info::to_text(&summary.manifest, summary.package_bytes, digits);
        messages::write_line(&format!("\n{text}"));
    } else {
        // The text has them, too.
        info::warnings(&summary.manifest).iter().for_each(|warning| messages::warning(warning));
    }
    messages::note(&format!("wrote {}", output.display()));
    watch.progress.tell_costs();
    Ok(ExitCode::Done)
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
