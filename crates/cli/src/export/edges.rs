//! `corniche export edges`: roads from junction to junction.

use std::path::Path;

use corniche_export::{EdgesSummary, FeatureRequest, export_edges};
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::Manifest;

use super::{MEMORY_BYTES, coordinates, facts, fill, format};
use crate::{
    args::ExportEdgesArgs,
    escaped::in_line,
    exit::ExitCode,
    failure::Failure,
    messages,
    named_output::NamedOutput,
    output::existing_of,
    packages, recorded,
    table::{Digits, bytes, length},
};

pub(crate) fn run(args: &ExportEdgesArgs) -> Result<ExitCode, Failure> {
    let vector = &args.vector;
    let format = format(vector.format, &vector.file.output)?;
    let coordinates = coordinates(vector)?;
    let usage = "corniche export edges PACKAGE -o FILE --dem FILE... --osm FILE...";
    let (place, [dem, osm]) = args.from.files(&args.extract.osm, usage)?;
    let package = packages::open_with_datum(&place, &vector.datum)?;
    let inputs: Vec<&Path> =
        [place.name()].into_iter().chain(dem.iter().chain(&osm).map(AsRef::as_ref)).collect();
    let name = format!("edges.{}", format.ending());
    let existing = existing_of(vector.file.overwrite);
    let output = NamedOutput::create(&vector.file.output, existing, name, &inputs)?;
    let Some(elevation) = recorded::elevation(&args.from, &dem, &package)? else {
        return Err(Failure::unusable(format!("no elevation file is named: {usage}")));
    };
    let Some(network) = recorded::network(&args.extract, &osm, (&args.cpu, &package))? else {
        return Err(Failure::unusable(format!("no extract is named: {usage}")));
    };
    let request = FeatureRequest {
        format,
        level: None,
        classes: FunctionalRoadClass::all().collect(),
        bounds: None,
        coordinates,
        memory_bytes: MEMORY_BYTES,
    };
    let inputs = (recorded::for_export(&elevation), &network);
    let (summary, size) = fill(&vector.file, output, Some(&elevation), |path, progress| {
        export_edges(&package, &request, inputs, path, progress)
    })?;
    messages::summary(&to_text(args, &summary, package.manifest(), size));
    Ok(ExitCode::Done)
}

fn to_text(
    args: &ExportEdgesArgs,
    summary: &EdgesSummary,
    manifest: &Manifest,
    size: u64,
) -> String {
    let count = |number| Digits::of_notes().count(number);
    format!(
        "{}: {} edges, {}, {}; {} more have no ground, {} no ascent (bridges, tunnels and ground that end within them)\n{}",
        in_line(&args.vector.file.output.to_string_lossy()),
        count(summary.edges),
        length((summary.length_m * 1e6).round() as u64),
        bytes(size),
        count(summary.without_ground),
        count(summary.without_ascent),
        facts(&args.vector, &summary.heights, manifest),
    )
}
