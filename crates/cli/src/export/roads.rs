//! `corniche export roads`: writes roads as lines with heights, lengths and grades.

use corniche_export::{
    ExportSummary, FeatureCoordinates, FeatureRequest, RoadFeatures, RoadHeights, VectorFormat,
    export_roads,
};
use corniche_tileset::Manifest;

use super::{
    lines::LinesExport,
    vector_files::{MEMORY_BYTES, facts, fill, spans_text},
};
use crate::{
    args::ExportRoadsArgs,
    escaped::in_line,
    failure::Result,
    messages, recorded,
    table::{bytes, length, noted, up_to},
};

pub(crate) fn run(args: &ExportRoadsArgs) -> Result<()> {
    let usage = "corniche export roads PACKAGE -o FILE --dem FILE...";
    let LinesExport { format, coordinates, package, output, elevation, network } =
        LinesExport::begin(&args.vector, args.at.level, &args.cpu, ("roads", usage))?;
    let request = FeatureRequest {
        format,
        level: args.at.level,
        classes: args.filter.of_package(package.manifest())?,
        bounds: args.within.bounds,
        coordinates,
        memory_bytes: MEMORY_BYTES,
    };
    let features = if args.pieces { RoadFeatures::Pieces } else { RoadFeatures::Ways };
    let heights = RoadHeights {
        elevation: elevation.as_ref().map(recorded::for_export),
        network: network.as_ref(),
    };
    let road = args.vector.road.query();
    let (summary, size) = fill(&args.vector.file, output, elevation.as_ref(), |path, progress| {
        export_roads(&package, &request, features, road.as_ref(), heights, path, progress)
    })?;
    if summary.features == 0 {
        let level = summary.level;
        warning!(
            "level {level} of the package has no roads of the selected classes within the bounds; the file has no features"
        );
    }
    messages::summary(&to_text(args, (coordinates, format), &summary, package.manifest(), size));
    Ok(())
}

fn to_text(
    args: &ExportRoadsArgs,
    coordinates: (FeatureCoordinates, VectorFormat),
    summary: &ExportSummary,
    manifest: &Manifest,
    size: u64,
) -> String {
    let what = if args.pieces {
        format!("{} pieces of {} ways", noted(summary.features), noted(summary.ways))
    } else {
        format!("{} ways", noted(summary.features))
    };
    let tolerance = match (summary.ground_tolerance_m, summary.height_tolerance_m) {
        (Some(ground_m), within_m) => format!(
            "heights are within {} m of the DEM along whole lines; the package's triangles are within {} m of the DEM there",
            up_to(within_m.unwrap_or_default(), 3),
            up_to(ground_m, 1),
        ),
        (None, Some(within_m)) => format!(
            "heights are within {} m of the DEM along whole lines, and within {} m at its samples; use --dem FILE for the DEM's own heights",
            up_to(within_m, 1),
            up_to(summary.sample_tolerance_m, 1),
        ),
        (None, None) => format!(
            "heights are within {} m of the DEM at its samples, and may differ more between them; use --dem FILE to measure the difference",
            up_to(summary.sample_tolerance_m, 1),
        ),
    };
    format!(
        "{}: {what} of level {}, {}, {} vertices, {}\n{}\n{tolerance}",
        in_line(&args.vector.file.output.to_string_lossy()),
        summary.level,
        length((summary.length_2d_m * 1e6).round() as u64),
        noted(summary.vertices),
        bytes(size),
        facts(coordinates, &summary.heights, manifest),
    ) + &summary.spans.as_ref().map(spans_text).unwrap_or_default()
}
