//! `corniche export`: what a package holds, for other programs.

mod geotiff;
mod mesh;
mod quantized_mesh;
mod tiles3d;
mod unknown_ending;

use std::path::Path;

use corniche_areas::AreaClass;
use corniche_export::{
    AreasRequest, AreasSummary, Coordinates, ExportSummary, RoadsRequest, VectorFormat,
    export_areas, export_roads,
};
use corniche_tileset::Manifest;

use self::unknown_ending::unknown_ending;
use crate::{
    args::{Export, ExportAreasArgs, ExportArgs, ExportCrs, ExportRoadsArgs, Format},
    escaped::in_line,
    exit::ExitCode,
    failure::Failure,
    messages,
    named_output::{NamedOutput, named},
    output::existing_of,
    packages,
    progress::Progress,
    table::{Digits, bytes, length},
};

/// Memory for sorting pieces of roads by way.
pub(crate) const MEMORY_BYTES: u64 = 128 << 20;

pub(crate) fn run(args: &ExportArgs) -> Result<ExitCode, Failure> {
    match &args.what {
        Export::Roads(args) => roads(args),
        Export::Areas(args) => areas(args),
        Export::Mesh(args) => mesh::run(args),
        Export::GeoTiff(args) => geotiff::run(args),
        Export::Tiles3d(args) => tiles3d::run(args),
        Export::QuantizedMesh(args) => quantized_mesh::run(args),
    }
}

fn roads(args: &ExportRoadsArgs) -> Result<ExitCode, Failure> {
    let format = format(args.format, &args.file.output)?;
    let coordinates = match (args.crs, args.heights) {
        (ExportCrs::Package, None) => Coordinates::Package,
        (ExportCrs::Wgs84, None) => Coordinates::Wgs84,
        (ExportCrs::Wgs84, Some(_)) => Coordinates::Wgs84WithPackageHeights,
        (ExportCrs::Package, Some(_)) => {
            return Err(Failure::unusable(
                "--heights as-is goes with --crs EPSG:4979; without it heights are the package's in any case",
            ));
        }
    };
    let package = packages::open_with_datum(&args.from.package, &args.datum)?;
    let request = RoadsRequest {
        format,
        level: args.at.level,
        classes: args.filter.classes.classes(),
        bounds: args.within.bounds,
        pieces: args.pieces,
        coordinates,
        memory_bytes: MEMORY_BYTES,
    };
    let name = format!("roads.{}", format.ending());
    let existing = existing_of(args.file.overwrite);
    let output =
        NamedOutput::create(&args.file.output, existing, name, &[args.from.package.name()])?;
    let progress = Progress::new();
    let exported = export_roads(&package, &request, &output.path(), &progress);
    progress.finish();
    let summary = exported.map_err(|error| named(error, &args.file.output))?;
    let size = output.place()?;
    messages::summary(&to_text(args, &summary, package.manifest(), size));
    Ok(ExitCode::Done)
}

fn areas(args: &ExportAreasArgs) -> Result<ExitCode, Failure> {
    let format = format(args.format, &args.file.output)?;
    let package = packages::open(&args.from.package)?;
    let request = AreasRequest {
        format,
        level: args.at.level,
        classes: if args.classes.is_empty() {
            AreaClass::ALL.to_vec()
        } else {
            args.classes.clone()
        },
        coordinates: match args.crs {
            ExportCrs::Package => Coordinates::Package,
            ExportCrs::Wgs84 => Coordinates::Wgs84WithPackageHeights,
        },
        memory_bytes: MEMORY_BYTES,
    };
    let name = format!("areas.{}", format.ending());
    let existing = existing_of(args.file.overwrite);
    let output =
        NamedOutput::create(&args.file.output, existing, name, &[args.from.package.name()])?;
    let progress = Progress::new();
    let exported = export_areas(&package, &request, &output.path(), &progress);
    progress.finish();
    let summary = exported.map_err(|error| named(error, &args.file.output))?;
    let size = output.place()?;
    if summary.unjoined > 0 {
        messages::warning(&format!(
            "{} areas could not be joined over borders of tiles; each of their parts is a polygon",
            summary.unjoined
        ));
    }
    messages::summary(&areas_to_text(args, &summary, package.manifest(), size));
    Ok(ExitCode::Done)
}

fn areas_to_text(
    args: &ExportAreasArgs,
    summary: &AreasSummary,
    manifest: &Manifest,
    size: u64,
) -> String {
    let count = |number| Digits::of_notes().count(number);
    let coordinates = match args.crs {
        ExportCrs::Package => &manifest.crs,
        ExportCrs::Wgs84 => "EPSG:4326",
    };
    format!(
        "{}: {} areas of level {}, {:.3} km², {} polygons, {} points, {}\ncoordinates: {}\nto be shown with it: {}",
        in_line(&args.file.output.to_string_lossy()),
        count(summary.areas),
        summary.level,
        summary.area_m2 / 1e6,
        count(summary.polygons),
        count(summary.points),
        bytes(size),
        in_line(coordinates),
        in_line(&manifest.attribution.join("; ")),
    )
}

/// The format that is named, or that of the ending.
fn format(format: Option<Format>, output: &Path) -> Result<VectorFormat, Failure> {
    let named = format.map(VectorFormat::from);
    named.or_else(|| VectorFormat::of_path(output)).ok_or_else(|| {
        let endings = VectorFormat::ALL.map(|format| format!(".{}", format.ending())).join(", ");
        unknown_ending(output, &endings)
    })
}

fn to_text(
    args: &ExportRoadsArgs,
    summary: &ExportSummary,
    manifest: &Manifest,
    size: u64,
) -> String {
    let count = |number| Digits::of_notes().count(number);
    let coordinates = match (args.crs, args.heights) {
        (ExportCrs::Package, _) => &manifest.crs,
        (ExportCrs::Wgs84, None) => "EPSG:4979",
        (ExportCrs::Wgs84, Some(_)) => "EPSG:4326",
    };
    let what = if args.pieces {
        format!("{} pieces of {} ways", count(summary.features), count(summary.ways))
    } else {
        format!("{} ways", count(summary.features))
    };
    format!(
        "{}: {what} of level {}, {}, {} vertices, {}\ncoordinates: {}\nheights: {}\nto be shown with it: {}",
        in_line(&args.file.output.to_string_lossy()),
        summary.level,
        length((summary.length_2d_m * 1e6).round() as u64),
        count(summary.vertices),
        bytes(size),
        in_line(coordinates),
        in_line(&summary.heights),
        in_line(&manifest.attribution.join("; ")),
    )
}
