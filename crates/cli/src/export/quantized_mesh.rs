//! `corniche export quantized-mesh`: terrain tiles of the globe.

use std::path::Path;

use corniche_export::{
    Coordinates, QuantizedMeshLevel, QuantizedMeshPlan, QuantizedMeshRequest, QuantizedMeshSummary,
    export_quantized_mesh,
};
use corniche_spec::machine::FileSystem;

use super::vector_files::{fill_folder, tell};
use crate::{
    args::ExportQuantizedMeshArgs,
    escaped::in_line,
    exit::ExitCode,
    failure::Failure,
    messages, packages,
    progress::Progress,
    settings,
    table::{bytes, noted},
};

/// Half of the block that most file systems have.
const HALF_BLOCK_BYTES: u64 = 2048;

pub(crate) fn run(args: &ExportQuantizedMeshArgs) -> Result<ExitCode, Failure> {
    let package = packages::open_with_datum(&args.from.package, &args.datum)?;
    let request = QuantizedMeshRequest {
        tiling: args.tiling,
        max_level: args.max_level,
        max_files: args.max_files,
        bounds: args.within.bounds,
        coordinates: args.heights.unwrap_or(Coordinates::Wgs84),
        availability: args.availability,
        gzip: args.compress,
        threads: settings::threads(args.cpu.threads),
    };
    let export = |folder: &Path, progress: &Progress| -> Result<_, Failure> {
        let plan = QuantizedMeshPlan::new(&package, &request)?;
        messages::note(&plan_text(&plan));
        refuse_full_disk(&plan, folder)?;
        let effort = plan.levels.iter().rev().map(|level| (level.tiles, level.effort));
        progress.expect_efforts(effort.collect());
        Ok(export_quantized_mesh(&package, (&request, plan), folder, progress)?)
    };
    let (summary, size) = fill_folder(&args.folder, &args.from, "quantized-mesh", export)?;
    tell(&args.folder.output, &to_text(&summary, size), package.manifest());
    Ok(ExitCode::Done)
}

/// What will be written.
fn plan_text(plan: &QuantizedMeshPlan) -> String {
    format!(
        "terrain      levels 0 to {}: at most {} files, about {} (an estimate from some tiles); --max-level chooses another finest level",
        plan.finest(),
        noted(plan.files()),
        bytes(plan.bytes),
    )
}

/// Refuses what has no room, as far as that can be told. A file takes half a block more than its bytes on average.
fn refuse_full_disk(plan: &QuantizedMeshPlan, folder: &Path) -> Result<(), Failure> {
    let needed = plan.bytes.saturating_add(plan.files() * HALF_BLOCK_BYTES);
    // Where nothing is known of the file system, writing tells.
    match FileSystem::of(folder) {
        Ok(FileSystem { free_bytes: free, .. }) if free < needed => {
            Err(Failure::unusable(format!(
                "about {} are needed for {} files, and {} are free there; choose a coarser level with --max-level, or another folder",
                bytes(needed),
                noted(plan.files()),
                bytes(free),
            )))
        }
        _ => Ok(()),
    }
}

fn to_text(summary: &QuantizedMeshSummary, size: u64) -> String {
    let level = |level: &QuantizedMeshLevel| {
        let deviation = if level.places == 0 {
            "not measured: no place with ground is on its raster".to_owned()
        } else {
            format!(
                "{:.3} m from the package at most ({:.3} m rms, {} places)",
                level.deviation_m,
                level.deviation_rms_m,
                noted(level.places),
            )
        };
        format!(
            "  level {}: {} tiles, {} triangles, {}, sampled {} × {}; assumed error {:.3} m, {deviation}\n",
            level.level,
            noted(level.tiles),
            noted(level.triangles),
            bytes(level.bytes),
            level.cells,
            level.cells,
            level.assumed_error_m,
        )
    };
    let tiles: u64 = summary.levels.iter().map(|level| level.tiles).sum();
    format!(
        "{} tiles, {}\n{}heights: {}",
        noted(tiles),
        bytes(size),
        summary.levels.iter().map(level).collect::<String>(),
        in_line(&summary.heights),
    )
}
