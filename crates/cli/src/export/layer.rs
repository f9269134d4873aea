//! `corniche export layer`: writes the lines, areas or points of a layer.

use corniche_export::{FeatureCoordinates, FeatureRequest, LayerSummary, export_layer};
use corniche_layers::LayerGeometry;

use super::vector_files::{MEMORY_BYTES, coordinates, crs_text, facts, fill};
use crate::{
    args::{ExportLayerArgs, VECTOR_FORMATS, word_of},
    credits::credits_line,
    escaped::in_line,
    failure::Result,
    messages,
    names::format_of,
    output::{existing_of, named::NamedOutput},
    packages,
    table::{bytes, length, noted},
};

pub(crate) fn run(args: &ExportLayerArgs) -> Result<()> {
    let format = format_of(args.format, &args.file.output, &VECTOR_FORMATS)?;
    let coordinates = coordinates(args.crs, false, format)?;
    let package = packages::open_with_datum(&args.from.package, &args.datum)?;
    let request = FeatureRequest {
        format,
        level: args.at.level,
        classes: args.classes.clone(),
        bounds: args.within.bounds,
        coordinates,
        memory_bytes: MEMORY_BYTES,
    };
    // An unknown layer has the name of no file.
    let known = package.manifest().layer(&args.layer).map_or("layer", |_| &args.layer);
    let name = format!("{known}.{}", word_of(&VECTOR_FORMATS, &format));
    let existing = existing_of(args.file.overwrite);
    let output =
        NamedOutput::create(&args.file.output, existing, name, &[args.from.package.name()])?;
    let (summary, size) = fill(&args.file, output, None, |path, progress| {
        export_layer(&package, (&args.layer, &args.lang), &request, path, progress)
    })?;
    warn(args, &summary);
    let manifest = package.manifest();
    let facts = if let Some(heights) = &summary.heights {
        facts((coordinates, format), heights, manifest)
    } else {
        let in_plan = match coordinates {
            FeatureCoordinates::Wgs84 => FeatureCoordinates::Wgs84WithPackageHeights,
            other => other,
        };
        let crs = crs_text(in_plan, format, manifest);
        format!("coordinates: {crs}{}", credits_line(manifest))
    };
    let name = args.file.output.to_string_lossy();
    messages::summary(&format!(
        "{}: {}, {}\n{facts}",
        in_line(&name),
        written(args, &summary),
        bytes(size)
    ));
    Ok(())
}

/// What was written, in words.
fn written(args: &ExportLayerArgs, summary: &LayerSummary) -> String {
    let LayerSummary { level, objects, parts, points, .. } = summary;
    let [objects, parts, points] = [objects, parts, points].map(|number| noted(*number));
    let begin = format!("{objects} objects of layer {} on level {level}", args.layer);
    match summary.geometry {
        LayerGeometry::Line => {
            let length = length((summary.length_m * 1e6).round() as u64);
            format!("{begin}, {length}, {parts} lines, {points} points")
        }
        LayerGeometry::Area => {
            let area_km2 = summary.area_m2 / 1e6;
            format!("{begin}, {area_km2:.3} km², {parts} polygons, {points} points")
        }
        LayerGeometry::Point => begin,
    }
}

fn warn(args: &ExportLayerArgs, summary: &LayerSummary) {
    let LayerSummary { level, objects, unjoined, without_ground, .. } = summary;
    if *objects == 0 {
        warning!(
            "level {level} of the package has no objects of layer {} in the selected classes within the bounds; the file has no features",
            args.layer
        );
    }
    if *unjoined > 0 {
        warning!(
            "{unjoined} areas could not be merged across tile borders; each of their parts is a separate polygon"
        );
    }
    if *without_ground > 0 {
        warning!("{without_ground} objects are where the package has no ground, and were skipped");
    }
}
