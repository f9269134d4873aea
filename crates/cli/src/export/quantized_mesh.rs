//! `corniche export quantized-mesh`: terrain tiles of the globe.

use corniche_export::{
    Availability, Coordinates, QuantizedMeshLevel, QuantizedMeshRequest, QuantizedMeshSummary,
    Tiling, export_quantized_mesh,
};
use corniche_tileset::Manifest;

use crate::{
    args::{ExportQuantizedMeshArgs, TerrainCompress},
    escaped::in_line,
    exit::ExitCode,
    failure::Failure,
    folder_output::FolderOutput,
    messages,
    named_output::named,
    output::existing_of,
    packages,
    progress::Progress,
    settings,
    table::{Digits, bytes},
};

pub(crate) fn run(args: &ExportQuantizedMeshArgs) -> Result<ExitCode, Failure> {
    let package = packages::open_with_datum(&args.from.package, &args.datum)?;
    let request = QuantizedMeshRequest {
        tiling: Tiling::from(args.tiling),
        max_level: args.max_level,
        bounds: args.within.bounds,
        coordinates: match args.heights {
            None => Coordinates::Wgs84,
            Some(_) => Coordinates::Wgs84WithPackageHeights,
        },
        availability: Availability::from(args.availability),
        gzip: args.compress == TerrainCompress::Gzip,
        threads: settings::threads(args.cpu.threads),
    };
    let existing = existing_of(args.folder.overwrite);
    let output = FolderOutput::create(&args.folder.output, existing, &[args.from.package.name()])?;
    let progress = Progress::new();
    let exported = export_quantized_mesh(&package, &request, output.path(), &progress);
    progress.finish();
    let summary = exported.map_err(|error| named(error, &args.folder.output))?;
    let size = output.place("quantized-mesh")?;
    messages::summary(&to_text(args, &summary, package.manifest(), size));
    Ok(ExitCode::Done)
}

fn to_text(
    args: &ExportQuantizedMeshArgs,
    summary: &QuantizedMeshSummary,
    manifest: &Manifest,
    size: u64,
) -> String {
    let count = |number| Digits::of_notes().count(number);
    let level = |level: &QuantizedMeshLevel| {
        let deviation = if level.places == 0 {
            "not measured: no place with ground is on its raster".to_owned()
        } else {
            format!(
                "{:.3} m from the package at most ({:.3} m rms, {} places)",
                level.deviation_m,
                level.deviation_rms_m,
                count(level.places),
            )
        };
        format!(
            "  level {}: {} tiles, {} triangles, {}, sampled {} × {}; assumed error {:.3} m, {deviation}\n",
            level.level,
            count(level.tiles),
            count(level.triangles),
            bytes(level.bytes),
            level.cells,
            level.cells,
            level.assumed_error_m,
        )
    };
    let tiles: u64 = summary.levels.iter().map(|level| level.tiles).sum();
    format!(
        "{}: {} tiles, {}\n{}heights: {}\nto be shown with it: {}",
        in_line(&args.folder.output.to_string_lossy()),
        count(tiles),
        bytes(size),
        summary.levels.iter().map(level).collect::<String>(),
        in_line(&summary.heights),
        in_line(&manifest.attribution.join("; ")),
    )
}
