//! `corniche build`: runs the pipeline.

use std::path::{Path, PathBuf};

use corniche_pieces::ExtractError;
use corniche_pipeline::{BuildError, BuildSummary};
use corniche_spec::{BuildSettings, Leftovers};

use crate::{
    args::BuildArgs,
    defects::DefectList,
    failure::Result,
    info, messages, output,
    part::make_tmp,
    progress::Progress,
    settings::{self, BuildWork},
    table::Digits,
    verdict,
};

pub(crate) fn run(mut args: Box<BuildArgs>) -> Result<()> {
    let written = settings::complete(&mut args.work)?;
    let Some(output) = args.output.take().or(written.package) else {
        refuse!(
            "no output package is named; pass -o PACKAGE.pmtiles, or write package under [output] in the settings file"
        );
    };
    output::writable_package(&output)?;
    let defects = args.defects.take().or(written.defects);
    if defects.is_some() && args.work.inputs.osm.is_empty() {
        refuse!("--defects lists the defects of an extract; pass one with --osm");
    }
    let mut others: Vec<&Path> = args.work.files().collect();
    others.push(&output);
    let progress = Progress::of_build(defects.as_deref(), args.overwrite, &others)?;
    let settings = settings(*args, output)?;
    make_tmp(settings.tmp.as_deref())?;
    let built = corniche_pipeline::build(&settings, &progress);
    finish(built, progress, &settings.output)
}

/// Reports the result of a build, and moves the list of defects to its target.
pub(crate) fn finish(
    built: Result<BuildSummary, BuildError>,
    mut progress: Progress,
    output: &Path,
) -> Result<()> {
    // The list replaces its target only if it is complete. It is also complete after a run that
    // failed because no road was kept: all roads were read, and the list has the reasons for their
    // loss.
    let is_complete = match &built {
        Ok(_)
        | Err(BuildError::Extract(ExtractError::NoRoads { .. }) | BuildError::NoGround { .. }) => {
            true
        }
        Err(_) => false,
    };
    let listed = progress.defects.take().filter(|_| is_complete).map_or(Ok(()), DefectList::finish);
    let summary = built?;
    listed?;
    let BuildSummary { manifest, package_bytes } = summary;
    if let Some(warning) = info::odd_heights(&manifest) {
        warning!("the package was written, but has an {warning}");
    }
    if messages::is_for_people() {
        let digits = Digits::of_notes();
        let verdict = verdict::to_text(&manifest, package_bytes, output, digits);
        messages::write_line(&format!("\n{}", verdict.trim_end()));
        if messages::is_detailed() {
            let text = info::to_text(&manifest, package_bytes, digits);
            messages::write_line(&format!("\n{text}"));
        }
    } else {
        note!("wrote {}", output.display());
    }
    progress.tell_costs();
    Ok(())
}

/// The settings of a build.
fn settings(args: BuildArgs, output: PathBuf) -> Result<BuildSettings> {
    let BuildWork { plan, resources, tmp, force } = settings::build_work(args.work)?;
    Ok(BuildSettings {
        plan,
        output,
        existing: output::existing_of(args.overwrite),
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
