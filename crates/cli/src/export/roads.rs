//! `corniche export roads`: roads as lines with heights, lengths and grades.

use std::path::Path;

use corniche_export::{ExportSummary, FeatureRequest, RoadFeatures, RoadHeights, export_roads};
use corniche_tileset::Manifest;

use super::{MEMORY_BYTES, coordinates, facts, fill, format};
use crate::{
    args::ExportRoadsArgs,
    escaped::in_line,
    exit::ExitCode,
    failure::Failure,
    messages,
    named_output::NamedOutput,
    output::existing_of,
    packages, recorded,
    table::{Digits, bytes, length},
};

pub(crate) fn run(args: &ExportRoadsArgs) -> Result<ExitCode, Failure> {
    let vector = &args.vector;
    let format = format(vector.format, &vector.file.output)?;
    let coordinates = coordinates(vector)?;
    let (place, [dem, osm]) = args
        .from
        .files(&args.extract.osm, "corniche export roads PACKAGE -o FILE --dem FILE...")?;
    let package = packages::open_with_datum(&place, &vector.datum)?;
    let inputs: Vec<&Path> =
        [place.name()].into_iter().chain(dem.iter().chain(&osm).map(AsRef::as_ref)).collect();
    let name = format!("roads.{}", format.ending());
    let existing = existing_of(vector.file.overwrite);
    let output = NamedOutput::create(&vector.file.output, existing, name, &inputs)?;
    let elevation = recorded::elevation(&args.from, &dem, &package)?;
    let network = recorded::network(&args.extract, &osm, (&args.cpu, &package))?;
    let request = FeatureRequest {
        format,
        level: args.at.level,
        classes: args.filter.classes.classes(),
        bounds: args.within.bounds,
        coordinates,
        memory_bytes: MEMORY_BYTES,
    };
    let features = if args.pieces { RoadFeatures::Pieces } else { RoadFeatures::Ways };
    let heights = RoadHeights {
        elevation: elevation.as_ref().map(recorded::for_export),
        network: network.as_ref(),
    };
    let (summary, size) = fill(&vector.file, output, elevation.as_ref(), |path, progress| {
        export_roads(&package, (&request, features), heights, path, progress)
    })?;
    messages::summary(&to_text(args, &summary, package.manifest(), size));
    Ok(ExitCode::Done)
}

fn to_text(
    args: &ExportRoadsArgs,
    summary: &ExportSummary,
    manifest: &Manifest,
    size: u64,
) -> String {
    let count = |number| Digits::of_notes().count(number);
    let what = if args.pieces {
        format!("{} pieces of {} ways", count(summary.features), count(summary.ways))
    } else {
        format!("{} ways", count(summary.features))
    };
    let within_m = summary.height_tolerance_m;
    let tolerance = match summary.ground_tolerance_m {
        None => format!(
            "heights are within {within_m:.1} m of the DEM at its samples; --dem FILE gives the DEM's own"
        ),
        Some(ground_m) => format!(
            "heights are those of the DEM, within {within_m:.3} m between vertices; the package's triangles are within {ground_m:.1} m of it there"
        ),
    };
    format!(
        "{}: {what} of level {}, {}, {} vertices, {}\n{}\n{tolerance}",
        in_line(&args.vector.file.output.to_string_lossy()),
        summary.level,
        length((summary.length_2d_m * 1e6).round() as u64),
        count(summary.vertices),
        bytes(size),
        facts(&args.vector, &summary.heights, manifest),
    )
}
