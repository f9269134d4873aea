//! `corniche match`: measures how far roads are offset from those visible in a photo or in the
//! terrain's slope.

mod map;
mod report;

use std::path::Path;

use corniche_matching::{MatchError, MatchRequest, MatchTarget, match_roads};
use corniche_photo::Photos;

use crate::{
    args::{MatchArgs, package_among},
    failure::Result,
    messages,
    output::{existing_of, report_files::ReportFiles},
    packages,
    progress::Progress,
    table::Digits,
};

pub(crate) fn run(args: &MatchArgs) -> Result<()> {
    let usage = "corniche match PACKAGE --photo FILE...";
    let (place, [photos]) = package_among(args.package.as_ref(), [&args.photo], usage)?;
    let package = packages::open(&place)?;
    let manifest = package.manifest();
    let photos = corniche_spec::inputs::photo_names(&photos)?;
    let inputs: Vec<&Path> = photos.iter().map(AsRef::as_ref).chain([place.name()]).collect();
    let list = [("--csv", args.csv.as_deref())];
    // Both paths are checked before any work is done.
    let files =
        ReportFiles::begin(args.svg.as_deref(), list, &inputs, existing_of(args.overwrite))?;
    let request = MatchRequest {
        classes: args.filter.of_package(manifest)?,
        radius_m: args.radius,
        region_m: args.region,
    };
    let compare = |target: &MatchTarget<'_>| {
        Progress::show_during(|progress| match_roads(&package, target, &request, progress))
    };
    let report = if args.slope {
        compare(&MatchTarget::Slope)?
    } else {
        let opened = Photos::open(&photos).map_err(MatchError::from)?;
        let grid = corniche_ground::terrain::recorded_grid::grid_of(manifest)?;
        let datums = grid.datums_of_rasters(opened.rasters()).allowed(args.allow_ballpark)?;
        datums.warnings().for_each(|text| messages::warning(&text));
        compare(&MatchTarget::Photos(&opened, &grid))?
    };
    files.write(
        |_, output| output.fill(report::to_csv(&report).as_bytes()),
        || Ok(map::to_svg(&report, manifest)),
    )?;
    let text = report::to_text(&report, manifest, Digits::of_answers());
    Ok(messages::answer(&text)?)
}
