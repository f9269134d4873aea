//! `corniche export`: what a package holds, for other programs.

mod edges;
mod geotiff;
mod lines;
mod mesh;
mod quantized_mesh;
mod roads;
mod tiles3d;
mod vector_files;

use std::path::Path;

use corniche_areas::{AreaClass, ClassedLayer};
use corniche_export::{FeatureRequest, FileFormat as _, export_areas, export_lines};
use corniche_remote::PackagePlace;
use corniche_tileset::{FilePackage, Manifest};

pub(crate) use self::vector_files::MEMORY_BYTES;
use self::vector_files::{coordinates, crs_text, fill, format, tell};
use crate::{
    args::{Export, ExportAreasArgs, ExportBoundariesArgs, FileArgs, InPlanArgs},
    exit::ExitCode,
    failure::Failure,
    messages,
    output::{existing_of, named::NamedOutput},
    packages,
    progress::Progress,
    recorded,
    table::{bytes, length, noted},
};

pub(crate) fn run(what: &Export) -> Result<ExitCode, Failure> {
    match what {
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
    let (package, request) =
        plan_request((&args.from.package, plan), &args.classes, &AreaClass::ALL)?;
    let name = format!("areas.{}", request.format.ending());
    let export =
        |path: &Path, progress: &Progress| export_areas(&package, &request, path, progress);
    let (summary, size) = write(&plan.file, name, args.from.package.name(), export)?;
    if summary.unjoined > 0 {
        messages::warning(&format!(
            "{} areas could not be joined over borders of tiles; each of their parts is a polygon",
            summary.unjoined
        ));
    }
    let what = format!(
        "{} areas of level {}, {:.3} km², {} polygons, {} points",
        noted(summary.areas),
        summary.level,
        summary.area_m2 / 1e6,
        noted(summary.polygons),
        noted(summary.points),
    );
    note_plan(plan, &request, &what, (package.manifest(), size));
    Ok(ExitCode::Done)
}

fn boundaries(args: &ExportBoundariesArgs) -> Result<ExitCode, Failure> {
    let (plan, layer) = (&args.plan, ClassedLayer::Boundaries);
    let (place, osm) = args.files()?;
    let (package, request) = plan_request((&place, plan), &args.classes, &layer.classes())?;
    let names = recorded::line_names((&args.extract, &osm), layer, (&args.cpu, &package))?;
    let name = format!("{}.{}", layer.name(), request.format.ending());
    let export = |path: &Path, progress: &Progress| {
        export_lines(&package, (layer, names.as_ref()), &request, path, progress)
    };
    let (summary, size) = write(&plan.file, name, place.name(), export)?;
    let what = format!(
        "{} ways of level {}, {}, {} lines, {} points",
        noted(summary.ways),
        summary.level,
        length((summary.length_m * 1e6).round() as u64),
        noted(summary.lines),
        noted(summary.points),
    );
    note_plan(plan, &request, &what, (package.manifest(), size));
    Ok(ExitCode::Done)
}

/// The package, and what is asked of a layer without heights; `classes` is empty for all.
fn plan_request<C: Copy>(
    (place, args): (&PackagePlace, &InPlanArgs),
    classes: &[C],
    all: &[C],
) -> Result<(FilePackage, FeatureRequest<C>), Failure> {
    let format = format(args.format, &args.file.output)?;
    let package = packages::open(place)?;
    let request = FeatureRequest {
        format,
        level: args.at.level,
        classes: if classes.is_empty() { all } else { classes }.to_vec(),
        bounds: args.within.bounds,
        coordinates: coordinates(args.crs, false, format)?,
        memory_bytes: MEMORY_BYTES,
    };
    Ok((package, request))
}

/// Writes a file in a folder beside its target, under its own name there, and puts it into its place. Gives its size, too.
fn write<T, E: Into<Failure>>(
    file: &FileArgs,
    name: String,
    package: &Path,
    export: impl FnOnce(&Path, &Progress) -> Result<T, E>,
) -> Result<(T, u64), Failure> {
    let output = NamedOutput::create(&file.output, existing_of(file.overwrite), name, &[package])?;
    fill(file, output, None, export)
}

/// Tells what was exported of a layer without heights.
fn note_plan<C>(
    args: &InPlanArgs,
    request: &FeatureRequest<C>,
    what: &str,
    (manifest, size): (&Manifest, u64),
) {
    let coordinates = crs_text(request.coordinates, request.format, manifest);
    let what = format!("{what}, {}\ncoordinates: {coordinates}", bytes(size));
    tell(&args.file.output, &what, manifest);
}
