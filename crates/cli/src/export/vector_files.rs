//! Common parts of exports to vector files and rasters: filling the file, and its format,
//! coordinates and heights in words.

use std::path::Path;

use corniche_export::{FeatureCoordinates, SpanFacts, VectorFormat};
use corniche_tileset::Manifest;
use corniche_verify::RecordedElevation;

use crate::{
    args::{FileArgs, FolderArgs, PackageArg},
    credits::credits_line,
    escaped::in_line,
    failure::{CommandFailure, Result},
    messages,
    output::{existing_of, folder::FolderOutput, named::NamedOutput},
    progress::Progress,
    table::noted,
};

/// Memory for sorting pieces by object.
pub(crate) const MEMORY_BYTES: u64 = 128 << 20;

/// Fills a file, and moves it to its target unless elevation files have changed meanwhile. Returns
/// its size, too.
pub(crate) fn fill<T, E: Into<CommandFailure>>(
    file: &FileArgs,
    output: NamedOutput,
    elevation: Option<&RecordedElevation>,
    export: impl FnOnce(&Path, &Progress) -> Result<T, E>,
) -> Result<(T, u64)> {
    let exported = Progress::show_during(|progress| export(&output.path(), progress));
    // A changed file may be the cause of any other error.
    elevation.map_or(Ok(()), RecordedElevation::check_unchanged)?;
    let summary = exported.map_err(|error| error.into().about_target(&file.output))?;
    Ok((summary, output.place()?))
}

/// Reports what was written, and its attribution.
pub(crate) fn tell(output: &Path, what: &str, manifest: &Manifest) {
    let name = output.to_string_lossy();
    messages::summary(&format!("{}: {what}{}", in_line(&name), credits_line(manifest)));
}

/// Fills a folder, which must not contain a file of the package, and moves it to its target.
/// Returns its size, too.
pub(crate) fn fill_folder<T, E: Into<CommandFailure>>(
    args: &FolderArgs,
    package: &PackageArg,
    what: &str,
    export: impl FnOnce(&Path, &Progress) -> Result<T, E>,
) -> Result<(T, u64)> {
    let used = [package.package.name()];
    let output = FolderOutput::create(&args.output, existing_of(args.overwrite), &used)?;
    let exported = Progress::show_during(|progress| export(output.path(), progress));
    let summary = exported.map_err(|error| error.into().about_target(&args.output))?;
    Ok((summary, output.place(what)?))
}

/// The requested coordinates; the default for GeoJSON is degrees. `keeps_heights` means that
/// heights are not converted.
pub(crate) fn coordinates(
    crs: Option<FeatureCoordinates>,
    keeps_heights: bool,
    format: VectorFormat,
) -> Result<FeatureCoordinates> {
    let unasked = match format {
        VectorFormat::GeoJson => FeatureCoordinates::Wgs84WithPackageHeights,
        _ => FeatureCoordinates::Package,
    };
    match crs.unwrap_or(unasked) {
        FeatureCoordinates::Package if keeps_heights => Err(unusable!(
            "--heights as-is applies only to --crs EPSG:4979; with other coordinates, heights are always the package's"
        )),
        FeatureCoordinates::Wgs84 if keeps_heights => {
            Ok(FeatureCoordinates::Wgs84WithPackageHeights)
        }
        asked => Ok(asked),
    }
}

/// The coordinates in words.
pub(crate) fn crs_text(
    coordinates: FeatureCoordinates,
    format: VectorFormat,
    manifest: &Manifest,
) -> String {
    let is_json = format == VectorFormat::GeoJson;
    match coordinates {
        FeatureCoordinates::Package => in_line(&manifest.crs).into_owned(),
        FeatureCoordinates::Wgs84 => "EPSG:4979".to_owned(),
        FeatureCoordinates::Wgs84WithPackageHeights if is_json => {
            "EPSG:4326, the CRS of GeoJSON (RFC 7946)".to_owned()
        }
        FeatureCoordinates::Wgs84WithPackageHeights => "EPSG:4326".to_owned(),
        FeatureCoordinates::Epsg(code) if is_json => {
            format!(
                "EPSG:{code}, in the member \"crs\"; programs that support only RFC 7946 treat them as degrees"
            )
        }
        FeatureCoordinates::Epsg(code) => format!("EPSG:{code}"),
    }
}

/// The coordinates and heights of exported lines, and their attribution, one line each.
pub(crate) fn facts(
    (coordinates, format): (FeatureCoordinates, VectorFormat),
    heights: &str,
    manifest: &Manifest,
) -> String {
    let is_json = format == VectorFormat::GeoJson;
    let hint = match coordinates {
        FeatureCoordinates::Wgs84WithPackageHeights if is_json => {
            "; as in the package (--crs EPSG:4979 converts them to the ellipsoid)"
        }
        _ => "",
    };
    format!(
        "coordinates: {}\nheights: {}{hint}{}",
        crs_text(coordinates, format, manifest),
        in_line(heights),
        credits_line(manifest),
    )
}

/// The largest number of nodes in the text; a list of defects has them all.
const MOST_NODES: usize = 5;
/// A line about bridges and tunnels, with the reasons to inspect them; empty if there are none.
pub(crate) fn spans_text(facts: &SpanFacts) -> String {
    if facts.spans == 0 {
        return String::new();
    }
    let reasons =
        facts.reasons.iter().map(|(reason, number)| format!(", {reason} {}", noted(*number)));
    let nodes: Vec<String> =
        facts.ground_nodes.iter().take(MOST_NODES).map(i64::to_string).collect();
    let more = if facts.ground_nodes.len() > MOST_NODES { " …" } else { "" };
    let nodes = match &nodes[..] {
        [] => String::new(),
        [one] => format!(" (ground_way_on_deck: node {one})"),
        some => format!(" (ground_way_on_deck: nodes {}{more})", some.join(" ")),
    };
    format!(
        "\nbridges and tunnels: {} with {} crossings; their heights are estimates{}{nodes}",
        noted(facts.spans),
        noted(facts.crossings),
        reasons.collect::<String>(),
    )
}
