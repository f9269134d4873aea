//! The inputs that a package was built from, reopened for commands that measure with them.

use std::path::PathBuf;

use corniche_areas::BoundaryNames;
use corniche_export::Elevation;
use corniche_network::Network;
use corniche_presets::frc_preset;
use corniche_roads::FrcTable;
use corniche_spec::BuildObserver;
use corniche_tileset::FilePackage;
use corniche_verify::{RecordedElevation, VerifyError, VerifyOsm};

use crate::{
    args::{ExtractArgs, RecordedArgs, ThreadsArg},
    failure::CommandFailure,
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
) -> Result<Option<RecordedElevation>, CommandFailure> {
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
    of: (&ThreadsArg, &FilePackage),
) -> Result<Option<Network>, CommandFailure> {
    from_extracts(args, osm, of, corniche_verify::network)
}

/// Reads the names of bounded areas, if extracts are named; those of another package are rejected.
pub(crate) fn boundary_names(
    (args, osm): (&ExtractArgs, &[PathBuf]),
    of: (&ThreadsArg, &FilePackage),
) -> Result<Option<BoundaryNames>, CommandFailure> {
    from_extracts(args, osm, of, corniche_verify::boundary_names)
}

fn from_extracts<T>(
    args: &ExtractArgs,
    osm: &[PathBuf],
    (cpu, package): (&ThreadsArg, &FilePackage),
    read: impl FnOnce(&FilePackage, &VerifyOsm, usize, &dyn BuildObserver) -> Result<T, VerifyError>,
) -> Result<Option<T>, CommandFailure> {
    if osm.is_empty() {
        return Ok(None);
    }
    let extract = VerifyOsm {
        paths: corniche_spec::inputs::extract_names(osm)?,
        table: frc_table(args.frc_table.as_deref(), package)?,
        areas: None,
        memory_bytes: MEMORY_BYTES,
    };
    let found =
        Progress::show_during(|progress| read(package, &extract, threads(cpu.threads), progress))?;
    Ok(Some(found))
}

/// The named FRC table, or the preset whose name the package records.
pub(crate) fn frc_table(
    named: Option<&str>,
    package: &FilePackage,
) -> Result<FrcTable, CommandFailure> {
    if let Some(table) = named {
        return presets::frc_table(table);
    }
    let name = &package.manifest().settings.frc_table;
    if frc_preset(name).is_none() {
        return Err(no_preset(package, &format!("FRC table {name:?}"), "--frc-table"));
    }
    presets::frc_table(name)
}

/// The failure for a package whose table does not come with the program.
pub(crate) fn no_preset(package: &FilePackage, table: &str, option: &str) -> CommandFailure {
    unusable!(
        "{:?} was built with the {table}, which is not a preset; pass its file with {option}",
        package.path()
    )
}
