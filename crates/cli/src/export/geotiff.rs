//! `corniche export geotiff`: heights as a raster.

use std::path::Path;

use corniche_export::{GeoTiffRequest, GeoTiffSummary, export_geotiff};
use corniche_tileset::{Manifest, SampleErrorRecord};

use super::vector_files::{fill, tell};
use crate::{
    args::ExportGeoTiffArgs,
    escaped::in_line,
    failure::Result,
    names::MAP,
    output::{existing_of, named::NamedOutput},
    packages, recorded,
    settings::threads,
    table::{bytes, noted},
};

pub(crate) fn run(args: &ExportGeoTiffArgs) -> Result<()> {
    if !MAP.is_of(&args.file.output) {
        refuse!(
            "cannot write {:?}: the output is a GeoTIFF; choose a name with the extension .tif",
            args.file.output
        );
    }
    let (place, [dem, _]) =
        args.from.files(&[], "corniche export geotiff PACKAGE --dem FILE...")?;
    let package = packages::open_with_datum(&place, &args.datum)?;
    let existing = existing_of(args.file.overwrite);
    let inputs: Vec<&Path> =
        [place.name()].into_iter().chain(dem.iter().map(AsRef::as_ref)).collect();
    let output =
        NamedOutput::create(&args.file.output, existing, "heights.tif".to_owned(), &inputs)?;
    let elevation = recorded::elevation(&args.from, &dem, &package)?;
    let request = GeoTiffRequest {
        level: args.at.level,
        bounds: args.within.bounds,
        elevation: elevation.as_ref().map(recorded::for_export),
        threads: threads(args.cpu.threads),
    };
    let (summary, size) = fill(&args.file, output, elevation.as_ref(), |path, progress| {
        export_geotiff(&package, &request, path, progress)
    })?;
    if !summary.has_same_crs {
        warning!(
            "GeoTIFF cannot represent the whole coordinate system of the package ({}, heights: {}); programs may interpret it differently",
            package.manifest().crs,
            summary.heights
        );
    }
    tell(&args.file.output, &to_text(&summary, package.manifest(), size), package.manifest());
    Ok(())
}

fn to_text(summary: &GeoTiffSummary, manifest: &Manifest, size: u64) -> String {
    let error = summary.sample_error.map_or_else(String::new, |error| {
        let SampleErrorRecord { on_tin, off_tin, max_m, rms_m, p99_m } = error;
        let points = if manifest.nodes_are_samples { "samples" } else { "nodes, which are between samples" };
        format!(
            "\nTIN minus DEM: max {max_m:.3} m, RMS {rms_m:.3} m, p99 {p99_m:.3} m at {} {points}; {} without ground",
            noted(on_tin),
            noted(off_tin)
        )
    });
    format!(
        "level {}, {} × {} nodes, {} with ground, {}, {}\nstored error: at most {:.3} m\ncoordinates: {}\nheights: {}{error}",
        summary.level,
        noted(summary.columns),
        noted(summary.rows),
        noted(summary.covered),
        summary.pixels,
        bytes(size),
        summary.error_bound_m,
        in_line(&manifest.crs),
        in_line(&summary.heights),
    )
}
