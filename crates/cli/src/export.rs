//! `corniche export`: what a package holds, for other programs.

mod edges;
mod geotiff;
mod lines;
mod mesh;
mod quantized_mesh;
mod roads;
mod tiles3d;
mod unknown_ending;

use std::path::Path;

use corniche_areas::{AreaClass, BoundaryClass};
use corniche_export::{
    Coordinates, ExportError, FeatureRequest, VectorFormat, export_areas, export_boundaries,
};
use corniche_pipeline::RecordedElevation;
use corniche_tileset::{FilePackage, Manifest};

use self::unknown_ending::unknown_ending;
use crate::{
    args::{
        Export, ExportAreasArgs, ExportArgs, ExportBoundariesArgs, ExportCrs, FileArgs, Format,
        InPlanArgs, VectorArgs,
    },
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

/// Memory for sorting pieces by their objects.
pub(crate) const MEMORY_BYTES: u64 = 128 << 20;

pub(crate) fn run(args: &ExportArgs) -> Result<ExitCode, Failure> {
    match &args.what {
        Export::Roads(args) => roads::run(args),
        Export::Edges(args) => edges::run(args),
        Export::Areas(args) => areas(args),
        Export::Boundaries(args) => boundaries(args),
        Export::Mesh(args) => mesh::run(args),
        Export::GeoTiff(args) => geotiff::run(args),
        Export::Tiles3d(args) => tiles3d::run(args),
        Export::QuantizedMesh(args) => quantized_mesh::run(args),
    }
}

fn areas(args: &ExportAreasArgs) -> Result<ExitCode, Failure> {
    let plan = &args.plan;
    let (package, request) = plan_request(plan, &args.classes, &AreaClass::ALL)?;
    let name = format!("areas.{}", request.format.ending());
    let export =
        |path: &Path, progress: &Progress| export_areas(&package, &request, path, progress);
    let (summary, size) = write(&plan.file, name, plan.from.package.name(), export)?;
    if summary.unjoined > 0 {
        messages::warning(&format!(
            "{} areas could not be joined over borders of tiles; each of their parts is a polygon",
            summary.unjoined
        ));
    }
    let count = |number| Digits::of_notes().count(number);
    let what = format!(
        "{} areas of level {}, {:.3} km², {} polygons, {} points",
        count(summary.areas),
        summary.level,
        summary.area_m2 / 1e6,
        count(summary.polygons),
        count(summary.points),
    );
    note_plan(plan, &what, package.manifest(), size);
    Ok(ExitCode::Done)
}

fn boundaries(args: &ExportBoundariesArgs) -> Result<ExitCode, Failure> {
    let plan = &args.plan;
    let (package, request) = plan_request(plan, &args.classes, &BoundaryClass::ALL)?;
    let name = format!("boundaries.{}", request.format.ending());
    let export =
        |path: &Path, progress: &Progress| export_boundaries(&package, &request, path, progress);
    let (summary, size) = write(&plan.file, name, plan.from.package.name(), export)?;
    let count = |number| Digits::of_notes().count(number);
    let what = format!(
        "{} ways of level {}, {}, {} lines, {} points",
        count(summary.ways),
        summary.level,
        length((summary.length_m * 1e6).round() as u64),
        count(summary.lines),
        count(summary.points),
    );
    note_plan(plan, &what, package.manifest(), size);
    Ok(ExitCode::Done)
}

/// The package, and what is asked of a layer without heights; `classes` is empty for all.
fn plan_request<C: Copy>(
    args: &InPlanArgs,
    classes: &[C],
    all: &[C],
) -> Result<(FilePackage, FeatureRequest<C>), Failure> {
    let format = format(args.format, &args.file.output)?;
    let package = packages::open(&args.from.package)?;
    let request = FeatureRequest {
        format,
        level: args.at.level,
        classes: if classes.is_empty() { all } else { classes }.to_vec(),
        bounds: args.within.bounds,
        coordinates: match args.crs {
            ExportCrs::Package => Coordinates::Package,
            ExportCrs::Wgs84 => Coordinates::Wgs84WithPackageHeights,
        },
        memory_bytes: MEMORY_BYTES,
    };
    Ok((package, request))
}

/// Writes a file in a folder beside its target, under its own name there, and puts it into its place. Gives its size, too.
fn write<T>(
    file: &FileArgs,
    name: String,
    package: &Path,
    export: impl FnOnce(&Path, &Progress) -> Result<T, ExportError>,
) -> Result<(T, u64), Failure> {
    let output = NamedOutput::create(&file.output, existing_of(file.overwrite), name, &[package])?;
    fill(file, output, None, export)
}

/// Writes a file that was begun, and puts it into its place unless elevation files have changed meanwhile. Gives its size, too.
fn fill<T>(
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

/// Tells what was exported of a layer without heights.
fn note_plan(args: &InPlanArgs, what: &str, manifest: &Manifest, size: u64) {
    let coordinates = match args.crs {
        ExportCrs::Package => &manifest.crs,
        ExportCrs::Wgs84 => "EPSG:4326",
    };
    messages::summary(&format!(
        "{}: {what}, {}\ncoordinates: {}\nto be shown with it: {}",
        in_line(&args.file.output.to_string_lossy()),
        bytes(size),
        in_line(coordinates),
        in_line(&manifest.attribution.join("; ")),
    ));
}

/// The format that is named, or that of the ending.
fn format(format: Option<Format>, output: &Path) -> Result<VectorFormat, Failure> {
    let named = format.map(VectorFormat::from);
    named.or_else(|| VectorFormat::of_path(output)).ok_or_else(|| {
        let endings = VectorFormat::ALL.map(|format| format!(".{}", format.ending())).join(", ");
        unknown_ending(output, &endings)
    })
}

/// The coordinates of lines with heights that are asked for.
fn coordinates(args: &VectorArgs) -> Result<Coordinates, Failure> {
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
fn facts(args: &VectorArgs, heights: &str, manifest: &Manifest) -> String {
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
