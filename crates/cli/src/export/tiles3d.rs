//! `corniche export 3dtiles`: writes a package as 3D Tiles.

use std::path::Path;

use corniche_export::{
    FeatureCoordinates, Tiles3dLevel, Tiles3dRequest, Tiles3dSummary, export_tiles3d,
};

use super::vector_files::{fill_folder, tell};
use crate::{
    args::ExportTiles3dArgs,
    escaped::in_line,
    failure::Result,
    packages,
    progress::Progress,
    settings, styles,
    table::{bytes, noted},
};

pub(crate) fn run(args: &ExportTiles3dArgs) -> Result<()> {
    let style = styles::style(&args.style)?;
    let package = packages::open_with_datum(&args.from.package, &args.datum)?;
    let request = Tiles3dRequest {
        finest_level: args.finest_level,
        bounds: args.within.bounds,
        roads: args.roads,
        classes: args.filter.of_package(package.manifest())?,
        style,
        relief: args.relief,
        skirts: args.skirts,
        compress: args.compress,
        coordinates: args.heights.unwrap_or(FeatureCoordinates::Wgs84),
        threads: settings::threads(args.cpu.threads),
    };
    let export =
        |folder: &Path, progress: &Progress| export_tiles3d(&package, &request, folder, progress);
    let (summary, size) = fill_folder(&args.folder, &args.from, "3D Tiles", export)?;
    tell(&args.folder.output, &to_text(&summary, size), package.manifest());
    Ok(())
}

fn to_text(summary: &Tiles3dSummary, size: u64) -> String {
    let level = |level: &Tiles3dLevel| {
        format!(
            "  level {}: {} tiles, {} triangles ({} in the package), {} of roads, {}, error {:.3} m, {:.1} ms per tile for cutting\n",
            level.level,
            noted(level.tiles),
            noted(level.triangles),
            noted(level.package_triangles),
            noted(level.road_triangles),
            bytes(level.bytes),
            level.error_m,
            level.cut_s * 1e3 / level.tiles.max(1) as f64,
        )
    };
    let total = |of: fn(&Tiles3dLevel) -> u64| summary.levels.iter().map(of).sum::<u64>();
    format!(
        "{} tiles, {}, {} tileset documents\n{}heights: {}",
        noted(total(|level| level.tiles)),
        bytes(size),
        noted(summary.documents),
        summary.levels.iter().map(level).collect::<String>(),
        in_line(&summary.heights),
    )
}
