//! The inputs that a package was made from, opened again for commands that measure with them.

use std::path::PathBuf;

use corniche_areas::{ClassedLayer, LineNames};
use corniche_export::Elevation;
use corniche_network::Network;
use corniche_presets::frc_preset;
use corniche_roads::FrcTable;
use corniche_spec::Observer;
use corniche_tileset::FilePackage;
use corniche_verify::{RecordedElevation, VerifyError, VerifyOsm};

use crate::{
    args::{ExtractArgs, RecordedArgs, ThreadsArg},
    failure::Failure,
    presets,
    progress::Progress,
    settings::{polygon, threads},
};

/// Memory for sorting what extracts hold.
pub(crate) const MEMORY_BYTES: u64 = 256 << 20;

/// The elevation files of a package, if some are named; those of another package are refused.
pub(crate) fn elevation(
    args: &RecordedArgs,
    dem: &[PathBuf],
    package: &FilePackage,
) -> Result<Option<RecordedElevation>, Failure> {
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

/// The roads of a package's extracts as a network, if some are named; those of another package are refused.
pub(crate) fn network(
    args: &ExtractArgs,
    osm: &[PathBuf],
    of: (&ThreadsArg, &FilePackage),
) -> Result<Option<Network>, Failure> {
    from_extracts(args, osm, of, corniche_verify::network)
}

/// The names of what the lines of a layer bound, if extracts are named; those of another package are refused.
pub(crate) fn line_names(
    (args, osm): (&ExtractArgs, &[PathBuf]),
    layer: ClassedLayer,
    of: (&ThreadsArg, &FilePackage),
) -> Result<Option<LineNames>, Failure> {
    from_extracts(args, osm, of, |package, extract, threads, observer| {
        corniche_verify::line_names(package, layer, extract, threads, observer)
    })
}

fn from_extracts<T>(
    args: &ExtractArgs,
    osm: &[PathBuf],
    (cpu, package): (&ThreadsArg, &FilePackage),
    read: impl FnOnce(&FilePackage, &VerifyOsm, usize, &dyn Observer) -> Result<T, VerifyError>,
) -> Result<Option<T>, Failure> {
    if osm.is_empty() {
        return Ok(None);
    }
    let extract = VerifyOsm {
        paths: corniche_spec::inputs::extract_names(osm)?,
        table: frc_table(args.frc_table.as_deref(), package)?,
        areas: None,
        memory_bytes: MEMORY_BYTES,
    };
    let found = Progress::of(|progress| read(package, &extract, threads(cpu.threads), progress))?;
    Ok(Some(found))
}

/// The FRC table that is named, or the preset whose name the package has.
pub(crate) fn frc_table(named: Option<&str>, package: &FilePackage) -> Result<FrcTable, Failure> {
    if let Some(table) = named {
        return presets::frc_table(table);
    }
    let name = &package.manifest().settings.frc_table;
    if frc_preset(name).is_none() {
        return Err(no_preset(package, &format!("FRC table {name:?}"), "--frc-table"));
    }
    presets::frc_table(name)
}

/// A package was made with a table that does not come with the program.
pub(crate) fn no_preset(package: &FilePackage, table: &str, option: &str) -> Failure {
    Failure::unusable(format!(
        "{} was made with the {table}, which is no preset; give its file with {option}",
        package.path().display()
    ))
}
