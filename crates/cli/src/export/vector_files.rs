//! What exports to vector files and rasters have in common: the file that is filled, its format, coordinates and heights in words.

use std::path::Path;

use corniche_export::{Coordinates, FileFormat, SpanFacts, VectorFormat};
use corniche_tileset::Manifest;
use corniche_verify::RecordedElevation;

use crate::{
    args::{FileArgs, FolderArgs, PackageArg},
    credits::credits_line,
    escaped::in_line,
    failure::Failure,
    messages, names,
    output::{existing_of, folder::FolderOutput, named::NamedOutput},
    progress::Progress,
    table::noted,
};

/// Memory for sorting pieces by their objects.
pub(crate) const MEMORY_BYTES: u64 = 128 << 20;

/// Writes a file that was begun, and puts it into its place unless elevation files have changed meanwhile. Gives its size, too.
pub(crate) fn fill<T, E: Into<Failure>>(
    file: &FileArgs,
    output: NamedOutput,
    elevation: Option<&RecordedElevation>,
    export: impl FnOnce(&Path, &Progress) -> Result<T, E>,
) -> Result<(T, u64), Failure> {
    let exported = Progress::of(|progress| export(&output.path(), progress));
    // A file that changed may be the cause of any other error.
    elevation.map_or(Ok(()), RecordedElevation::check_unchanged)?;
    let summary = exported.map_err(|error| error.into().about_target(&file.output))?;
    Ok((summary, output.place()?))
}

/// Tells what was written, and what is to be shown with it.
pub(crate) fn tell(output: &Path, what: &str, manifest: &Manifest) {
    let name = output.to_string_lossy();
    messages::summary(&format!("{}: {what}{}", in_line(&name), credits_line(manifest)));
}

/// Writes a folder, which is none with a file of the package, and puts it into its place. Gives its size, too.
pub(crate) fn fill_folder<T, E: Into<Failure>>(
    args: &FolderArgs,
    package: &PackageArg,
    what: &str,
    export: impl FnOnce(&Path, &Progress) -> Result<T, E>,
) -> Result<(T, u64), Failure> {
    let used = [package.package.name()];
    let output = FolderOutput::create(&args.output, existing_of(args.overwrite), &used)?;
    let exported = Progress::of(|progress| export(output.path(), progress));
    let summary = exported.map_err(|error| error.into().about_target(&args.output))?;
    Ok((summary, output.place(what)?))
}

/// The format that is named, or that of the ending.
pub(crate) fn format<F: FileFormat>(named: Option<F>, output: &Path) -> Result<F, Failure> {
    named.or_else(|| F::of_path(output)).ok_or_else(|| {
        let endings: Vec<_> = F::ALL.iter().map(|of| format!(".{}", of.ending())).collect();
        names::unknown_ending(output, &endings.join(", "))
    })
}

/// The coordinates that are asked for; of GeoJSON degrees, where nothing is. `keeps_heights` says that heights are to stay as they are.
pub(crate) fn coordinates(
    crs: Option<Coordinates>,
    keeps_heights: bool,
    format: VectorFormat,
) -> Result<Coordinates, Failure> {
    let unasked = match format {
        VectorFormat::GeoJson => Coordinates::Wgs84WithPackageHeights,
        _ => Coordinates::Package,
    };
    match crs.unwrap_or(unasked) {
        Coordinates::Package if keeps_heights => Err(Failure::unusable(
            "--heights as-is goes with --crs EPSG:4979; without it heights are the package's in any case",
        )),
        Coordinates::Wgs84 if keeps_heights => Ok(Coordinates::Wgs84WithPackageHeights),
        asked => Ok(asked),
    }
}

/// Coordinates in words.
pub(crate) fn crs_text(
    coordinates: Coordinates,
    format: VectorFormat,
    manifest: &Manifest,
) -> String {
    let is_json = format == VectorFormat::GeoJson;
    match coordinates {
        Coordinates::Package => in_line(&manifest.crs).into_owned(),
        Coordinates::Wgs84 => "EPSG:4979".to_owned(),
        Coordinates::Wgs84WithPackageHeights if is_json => {
            "EPSG:4326, the degrees that GeoJSON has (RFC 7946)".to_owned()
        }
        Coordinates::Wgs84WithPackageHeights => "EPSG:4326".to_owned(),
        Coordinates::Epsg(code) if is_json => {
            format!(
                "EPSG:{code}, in the member \"crs\"; programs that know only RFC 7946 take them for degrees"
            )
        }
        Coordinates::Epsg(code) => format!("EPSG:{code}"),
    }
}

/// What coordinates and heights of exported lines are, and what is to be shown with them, a line each.
pub(crate) fn facts(
    (coordinates, format): (Coordinates, VectorFormat),
    heights: &str,
    manifest: &Manifest,
) -> String {
    let is_json = format == VectorFormat::GeoJson;
    let hint = match coordinates {
        Coordinates::Wgs84WithPackageHeights if is_json => {
            "; as the package has them (--crs EPSG:4979 carries them to the ellipsoid)"
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

/// So many nodes are named; a list of defects has them all.
const MOST_NODES: usize = 5;
/// A line of bridges and tunnels, and of what is to be known of them; nothing where there is none.
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
