//! `corniche match`: how far roads lie beside what a photo or the slope of the ground shows of them.

mod map;
mod report;

use std::path::Path;

use corniche_matching::{MatchError, MatchRequest, Target, match_roads};
use corniche_photo::Photos;

use crate::{
    args::{MatchArgs, package_among},
    exit::ExitCode,
    failure::Failure,
    messages,
    output::{existing_of, report_files::ReportFiles},
    packages,
    progress::Progress,
    table::Digits,
};

pub(crate) fn run(args: &MatchArgs) -> Result<ExitCode, Failure> {
    let usage = "corniche match PACKAGE --photo FILE...";
    let (place, [photos]) = package_among(args.package.as_ref(), [&args.photo], usage)?;
    let package = packages::open(&place)?;
    let manifest = package.manifest();
    let photos = corniche_spec::inputs::photo_names(&photos)?;
    let inputs: Vec<&Path> = photos.iter().map(AsRef::as_ref).chain([place.name()]).collect();
    let list = [("--csv", args.csv.as_deref())];
    // Both places are looked at before any work is done.
    let files =
        ReportFiles::begin(args.svg.as_deref(), list, &inputs, existing_of(args.overwrite))?;
    let request = MatchRequest {
        classes: args.filter.classes.classes(),
        radius_m: args.radius,
        region_m: args.region,
    };
    let compare = |target: &Target<'_>| {
        Progress::of(|progress| match_roads(&package, target, &request, progress))
    };
    let report = if args.slope {
        compare(&Target::Slope)?
    } else {
        let opened = Photos::open(&photos).map_err(MatchError::from)?;
        let grid = corniche_ground::terrain::recorded_grid::grid_of(manifest)
            .map_err(|error| Failure::new(ExitCode::Unusable, error))?;
        let datums = grid.datums_of_rasters(opened.rasters()).allowed(args.allow_ballpark);
        let datums = datums.map_err(|error| Failure::new(ExitCode::Unusable, error))?;
        datums.warnings().for_each(|text| messages::warning(&text));
        compare(&Target::Photos(&opened, &grid))?
    };
    files.write(
        |_, output| output.fill(report::to_csv(&report).as_bytes()),
        || Ok(map::to_svg(&report, manifest)),
    )?;
    let text = report::to_text(&report, manifest, Digits::of_answers());
    messages::answer(&text)?;
    Ok(ExitCode::Done)
}
