//! What exports to vector files and rasters have in common: the file that is filled, its format, coordinates and heights in words.

use std::path::Path;

use corniche_export::{Coordinates, ExportError, SpanFacts, VectorFormat};
use corniche_pipeline::RecordedElevation;
use corniche_tileset::Manifest;

use super::unknown_ending::unknown_ending;
use crate::{
    args::{ExportCrs, FileArgs, Format, VectorArgs},
    escaped::in_line,
    failure::Failure,
    named_output::{NamedOutput, named},
    progress::Progress,
    table::Digits,
};

/// Memory for sorting pieces by their objects.
pub(crate) const MEMORY_BYTES: u64 = 128 << 20;

/// Writes a file that was begun, and puts it into its place unless elevation files have changed meanwhile. Gives its size, too.
pub(crate) fn fill<T>(
    file: &FileArgs,
    output: NamedOutput,
    elevation: Option<&RecordedElevation>,
    export: impl FnOnce(&Path, &Progress) -> Result<T, ExportError>,
) -> Result<(T, u64), Failure> {
    let progress = Progress::new();
    let exported = export(&output.path(), &progress);
    progress.finish();
    // A file that changed may be the cause of any other error.
    elevation.map_or(Ok(()), RecordedElevation::check_unchanged)?;
    let summary = exported.map_err(|error| named(error, &file.output))?;
    Ok((summary, output.place()?))
}

/// The format that is named, or that of the ending.
pub(crate) fn format(format: Option<Format>, output: &Path) -> Result<VectorFormat, Failure> {
    let named = format.map(VectorFormat::from);
    named.or_else(|| VectorFormat::of_path(output)).ok_or_else(|| {
        let endings = VectorFormat::ALL.map(|format| format!(".{}", format.ending())).join(", ");
        unknown_ending(output, &endings)
    })
}

/// The coordinates of lines with heights that are asked for.
pub(crate) fn coordinates(args: &VectorArgs) -> Result<Coordinates, Failure> {
    match (args.crs, args.heights) {
        (ExportCrs::Package, None) => Ok(Coordinates::Package),
        (ExportCrs::Wgs84, None) => Ok(Coordinates::Wgs84),
        (ExportCrs::Wgs84, Some(_)) => Ok(Coordinates::Wgs84WithPackageHeights),
        (ExportCrs::Package, Some(_)) => Err(Failure::unusable(
            "--heights as-is goes with --crs EPSG:4979; without it heights are the package's in any case",
        )),
    }
}

/// What coordinates and heights of exported lines are, and what is to be shown with them, a line each.
pub(crate) fn facts(args: &VectorArgs, heights: &str, manifest: &Manifest) -> String {
    let coordinates = match (args.crs, args.heights) {
        (ExportCrs::Package, _) => &manifest.crs,
        (ExportCrs::Wgs84, None) => "EPSG:4979",
        (ExportCrs::Wgs84, Some(_)) => "EPSG:4326",
    };
    format!(
        "coordinates: {}\nheights: {}\nto be shown with it: {}",
        in_line(coordinates),
        in_line(heights),
        in_line(&manifest.attribution.join("; ")),
    )
}

/// A line of bridges and tunnels, and of what is to be known of them; nothing where there is none.
pub(crate) fn spans_text(facts: &SpanFacts) -> String {
    if facts.spans == 0 {
        return String::new();
    }
    let count = |number| Digits::of_notes().count(number);
    let reasons =
        facts.reasons.iter().map(|(reason, number)| format!(", {reason} {}", count(*number)));
    format!(
        "\nbridges and tunnels: {} with {} crossings; their heights are estimates{}",
        count(facts.spans),
        count(facts.crossings),
        reasons.collect::<String>(),
    )
}
