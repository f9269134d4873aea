//! The inputs that a package was built from, reopened for commands that measure with them.

use std::path::PathBuf;

use corniche_export::Elevation;
use corniche_network::Network;
use corniche_presets::frc_preset;
use corniche_roads::FrcTable;
use corniche_tileset::FilePackage;
use corniche_verify::{RecordedElevation, VerifyOsm};

use crate::{
    args::{ExtractArgs, RecordedArgs, ThreadsArg},
    failure::Result,
    presets,
    progress::Progress,
    settings::{polygon, threads},
};

/// Memory for sorting the contents of extracts.
pub(crate) const MEMORY_BYTES: u64 = 256 << 20;

/// Opens the elevation files of a package, if some are named; those of another package are
/// rejected.
pub(crate) fn elevation(
    args: &RecordedArgs,
    dem: &[PathBuf],
    package: &FilePackage,
) -> Result<Option<RecordedElevation>> {
    if dem.is_empty() {
        return Ok(None);
    }
    let files = corniche_spec::inputs::elevation_names(dem)?;
    let polygon = args.polygon.clone().map(polygon).transpose()?;
    Ok(Some(RecordedElevation::open(package, &files, polygon, &Progress::new())?))
}

/// Elevation files for an export.
pub(crate) fn for_export(recorded: &RecordedElevation) -> Elevation<'_> {
    Elevation { dem: &recorded.dem, plan: &recorded.plan }
}

/// Opens the roads of a package's extracts as a network, if some are named; those of another
/// package are rejected.
pub(crate) fn network(
    args: &ExtractArgs,
    osm: &[PathBuf],
    (cpu, package): (&ThreadsArg, &FilePackage),
) -> Result<Option<Network>> {
    if osm.is_empty() {
        return Ok(None);
    }
    let extract = VerifyOsm {
        paths: corniche_spec::inputs::extract_names(osm)?,
        table: frc_table(args.frc_table.as_deref(), package)?,
        memory_bytes: MEMORY_BYTES,
    };
    let threads = threads(cpu.threads);
    let found = Progress::show_during(|progress| {
        corniche_verify::network(package, &extract, threads, progress)
    })?;
    Ok(Some(found))
}

/// The named FRC table, or the preset whose name the package records.
pub(crate) fn frc_table(named: Option<&str>, package: &FilePackage) -> Result<FrcTable> {
    if let Some(table) = named {
        return presets::frc_table(table);
    }
    let name = &package.manifest().settings.frc_table;
    if frc_preset(name).is_none() {
        refuse!(
            "{:?} was built with the FRC table {name:?}, which is not a preset; pass its file with --frc-table",
            package.path()
        );
    }
    presets::frc_table(name)
}
