//! `corniche export quantized-mesh`: writes terrain tiles for CesiumJS.

use std::path::Path;

use corniche_export::{
    FeatureCoordinates, QuantizedMeshLevel, QuantizedMeshPlan, QuantizedMeshRequest,
    QuantizedMeshSummary, export_quantized_mesh,
};
use corniche_spec::machine::FileSystem;

use super::vector_files::{fill_folder, tell};
use crate::{
    args::ExportQuantizedMeshArgs,
    escaped::in_line,
    failure::Result,
    messages, packages,
    progress::Progress,
    settings,
    table::{bytes, noted},
};

/// Half the block size of most file systems.
const HALF_BLOCK_BYTES: u64 = 2048;

pub(crate) fn run(args: &ExportQuantizedMeshArgs) -> Result<()> {
    let package = packages::open_with_datum(&args.from.package, &args.datum)?;
    let request = QuantizedMeshRequest {
        tiling: args.tiling,
        max_level: args.max_level,
        max_files: args.max_files,
        bounds: args.within.bounds,
        coordinates: args.heights.unwrap_or(FeatureCoordinates::Wgs84),
        availability: args.availability,
        gzip: args.compress,
        threads: settings::threads(args.cpu.threads),
    };
    let export = |folder: &Path, progress: &Progress| -> Result<_> {
        let plan = QuantizedMeshPlan::new(&package, &request)?;
        messages::note(&plan_text(&plan));
        refuse_full_disk(&plan, folder)?;
        let effort = plan.levels.iter().rev().map(|level| (level.tiles, level.effort));
        progress.expect_efforts(effort.collect());
        Ok(export_quantized_mesh(&package, (&request, plan), folder, progress)?)
    };
    let (summary, size) = fill_folder(&args.folder, &args.from, "quantized-mesh", export)?;
    tell(&args.folder.output, &to_text(&summary, size), package.manifest());
    Ok(())
}

/// The summary of what will be written.
fn plan_text(plan: &QuantizedMeshPlan) -> String {
    format!(
        "terrain      levels 0 to {}: at most {} files, about {} (estimated from some tiles); change the finest level with --max-level",
        plan.finest(),
        noted(plan.files()),
        bytes(plan.bytes),
    )
}

/// Rejects an export that does not fit on the disk, as far as this is known. On average a file
/// occupies half a block more than its bytes.
fn refuse_full_disk(plan: &QuantizedMeshPlan, folder: &Path) -> Result<()> {
    let needed = plan.bytes.saturating_add(plan.files() * HALF_BLOCK_BYTES);
    // If the file system reports nothing, writing detects a full disk.
    match FileSystem::containing(folder) {
        Ok(FileSystem { free_bytes: free, .. }) if free < needed => Err(unusable!(
            "about {} are needed for {} files, but only {} are free; choose a coarser level with --max-level, or another folder",
            bytes(needed),
            noted(plan.files()),
            bytes(free),
        )),
        _ => Ok(()),
    }
}

fn to_text(summary: &QuantizedMeshSummary, size: u64) -> String {
    let level = |level: &QuantizedMeshLevel| {
        let deviation = if level.places == 0 {
            "not measured: no point with ground is on its raster".to_owned()
        } else {
            format!(
                "at most {:.3} m from the package ({:.3} m RMS, {} points)",
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
