//! `corniche export edges`: roads from junction to junction.

use corniche_export::{
    EdgesSummary, FeatureCoordinates, FeatureRequest, VectorFormat, export_edges,
};
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::Manifest;

use super::{
    lines::LinesExport,
    vector_files::{MEMORY_BYTES, facts, fill, spans_text},
};
use crate::{
    args::ExportEdgesArgs,
    escaped::in_line,
    failure::Result,
    messages, recorded,
    table::{bytes, length, noted, up_to},
};

pub(crate) fn run(args: &ExportEdgesArgs) -> Result<()> {
    let usage = "corniche export edges PACKAGE -o FILE --dem FILE... --osm FILE...";
    let LinesExport { format, coordinates, package, output, elevation, network } =
        LinesExport::begin(&args.vector, None, &args.cpu, ("edges", usage))?;
    // The package may be among the values of these options.
    let (Some(elevation), Some(network)) = (elevation, network) else {
        refuse!("an elevation file and an extract are required: {usage}");
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
    let road = args.vector.road.query();
    let (summary, size) = fill(&args.vector.file, output, Some(&elevation), |path, progress| {
        export_edges(&package, (&request, road.as_ref()), inputs, path, progress)
    })?;
    messages::summary(&to_text(args, (coordinates, format), &summary, package.manifest(), size));
    Ok(())
}

fn to_text(
    args: &ExportEdgesArgs,
    coordinates: (FeatureCoordinates, VectorFormat),
    summary: &EdgesSummary,
    manifest: &Manifest,
    size: u64,
) -> String {
    let some = |number, what: &str| match number {
        0 => String::new(),
        _ => format!("; {} {what}", noted(number)),
    };
    format!(
        "{}: {} edges, {}, {}{}{}\n{}\nheights are within {} m of the DEM along whole lines",
        in_line(&args.vector.file.output.to_string_lossy()),
        noted(summary.edges),
        length((summary.length_m * 1e6).round() as u64),
        bytes(size),
        some(summary.without_ground, "skipped, without ground"),
        some(
            summary.without_ascent,
            "without an ascent, because the ground ends, or a bridge or tunnel has no ends on the ground",
        ),
        facts(coordinates, &summary.heights, manifest),
        up_to(summary.height_tolerance_m, 3),
    ) + &spans_text(&summary.spans)
}
