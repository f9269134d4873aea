//! `corniche export`: converts packages to formats of other programs.

mod edges;
mod geotiff;
mod lines;
mod mesh;
mod quantized_mesh;
mod roads;
mod tiles3d;
mod vector_files;

use std::path::Path;

use corniche_areas::{AreaClass, BoundaryClass};
use corniche_export::{FeatureRequest, export_areas, export_boundaries};
use corniche_remote::PackagePlace;
use corniche_tileset::{FilePackage, Manifest};

pub(crate) use self::vector_files::MEMORY_BYTES;
use self::vector_files::{coordinates, crs_text, fill, tell};
use crate::{
    args::{
        Export, ExportAreasArgs, ExportBoundariesArgs, FileArgs, InPlanArgs, VECTOR_FORMATS,
        package_among, word_of,
    },
    failure::CommandFailure,
    messages,
    names::format_of,
    output::{existing_of, named::NamedOutput},
    packages,
    progress::Progress,
    recorded,
    table::{bytes, length, noted},
};

pub(crate) fn run(what: &Export) -> Result<(), CommandFailure> {
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

fn areas(args: &ExportAreasArgs) -> Result<(), CommandFailure> {
    let plan = &args.plan;
    let (package, request) =
        plan_request((&args.from.package, plan), &args.classes, &AreaClass::ALL)?;
    let name = format!("areas.{}", word_of(&VECTOR_FORMATS, &request.format));
    let export =
        |path: &Path, progress: &Progress| export_areas(&package, &request, path, progress);
    let (summary, size) = write(&plan.file, name, args.from.package.name(), export)?;
    if summary.unjoined > 0 {
        messages::warning(&format!(
            "{} areas could not be merged across tile borders; each of their parts is a separate polygon",
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
    Ok(())
}

fn boundaries(args: &ExportBoundariesArgs) -> Result<(), CommandFailure> {
    let plan = &args.plan;
    let usage = "corniche export boundaries PACKAGE -o FILE --osm FILE…";
    let (place, [osm]) = package_among(args.package.as_ref(), [&args.extract.osm], usage)?;
    let (package, request) = plan_request((&place, plan), &args.classes, &BoundaryClass::ALL)?;
    let names = recorded::boundary_names((&args.extract, &osm), (&args.cpu, &package))?;
    let name = format!("boundaries.{}", word_of(&VECTOR_FORMATS, &request.format));
    let export = |path: &Path, progress: &Progress| {
        export_boundaries(&package, names.as_ref(), &request, path, progress)
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
    Ok(())
}

/// The package, and the request for a layer without heights; `classes` is empty for all.
fn plan_request<C: Copy>(
    (place, args): (&PackagePlace, &InPlanArgs),
    classes: &[C],
    all: &[C],
) -> Result<(FilePackage, FeatureRequest<C>), CommandFailure> {
    let format = format_of(args.format, &args.file.output, &VECTOR_FORMATS)?;
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

/// Writes a file in a temporary folder next to its target, under its own name, and moves it to its
/// target. Returns its size, too.
fn write<T, E: Into<CommandFailure>>(
    file: &FileArgs,
    name: String,
    package: &Path,
    export: impl FnOnce(&Path, &Progress) -> Result<T, E>,
) -> Result<(T, u64), CommandFailure> {
    let output = NamedOutput::create(&file.output, existing_of(file.overwrite), name, &[package])?;
    fill(file, output, None, export)
}

/// Reports the export of a layer without heights.
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
