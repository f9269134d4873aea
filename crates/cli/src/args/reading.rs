//! Commands that report what a package contains.

use std::{fmt::Write as _, path::PathBuf};

use clap::{Args, ValueEnum, ValueHint};
use corniche_geom::TileId;
use corniche_remote::PackagePlace;
use corniche_verify::CheckId;

use super::{
    shared::{PackageArg, ThreadsArg},
    values::{package_place, parse_position},
    voice::json_progress,
};
/// The end of `verify --help`: the checks, by their ids.
fn checks() -> String {
    let mut text =
        "The last line is the verdict; with --quiet only the verdict and broken checks are printed.\n\n\
         Checks (see docs/promises.md); the exit code is 1 if one is broken:\n"
            .to_owned();
    for check in CheckId::ALL {
        let needs = check.needs().text().replace('`', "");
        let _ = writeln!(text, "  {:<21} {} [{needs}]", check.id(), check.promise());
    }
    text
}

#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    #[command(flatten)]
    pub from: PackageArg,
    /// Print JSON, for programs
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
#[command(arg = json_progress(), after_long_help = checks(), override_usage = "corniche verify [OPTIONS] <PACKAGE>")]
pub(crate) struct VerifyArgs {
    /// The package: a file, or a URL (https://…)
    #[arg(required_unless_present_any = ["dem", "photo", "osm"], value_parser = package_place(), value_hint = ValueHint::AnyPath)]
    pub package: Option<PackagePlace>,
    /// The DEM the package was built from (same files, same order): checks the stored errors
    /// against the true ones
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub dem: Vec<PathBuf>,
    /// The photos the package was built from, in the same order: reads them again and checks the
    /// photo of every tile
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub photo: Vec<PathBuf>,
    /// The extracts the package was built from: reads them again and checks roads, attributes and
    /// counts
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub osm: Vec<PathBuf>,
    /// With --dem or --osm: the polygon that the package was clipped to
    #[arg(long, value_name = "FILE")]
    pub polygon: Option<PathBuf>,
    /// With --osm: the FRC table (functional road classes) the package was built with [default: the
    /// preset of the recorded name]
    #[arg(long, value_name = "NAME|FILE", requires = "osm")]
    pub frc_table: Option<String>,
    #[command(flatten)]
    pub cpu: ThreadsArg,
    /// Print JSON, for programs
    #[arg(long)]
    pub json: bool,
}

/// The coordinates in a dump.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum DumpCoordinates {
    /// Working metres: the CRS's coordinates times the package's `metres_per_unit`
    #[default]
    Working,
    /// The package's CRS: degrees, feet or metres; longitudes may continue past 180
    Crs,
}

#[derive(Debug, Args)]
pub(crate) struct TileArgs {
    #[command(flatten)]
    pub from: PackageArg,
    /// The tile: level, column from the west, row from the north
    #[arg(value_name = "Z/X/Y", required_unless_present = "at")]
    pub id: Option<TileId>,
    /// The finest tile at this longitude and latitude (degrees, WGS84), instead of Z/X/Y
    #[arg(long, value_name = "LON,LAT", value_parser = parse_position, allow_hyphen_values = true, conflicts_with = "id")]
    pub at: Option<[f64; 2]>,
    /// With --at: the tile of this level
    #[arg(long, value_name = "Z", requires = "at", conflicts_with = "id")]
    pub level: Option<u8>,
    /// Print everything in the tile as JSON, for programs: terrain with normals, roads and
    /// attributes, in working metres
    #[arg(long)]
    pub json: bool,
    /// The coordinates x and y in the JSON: working metres, or the package's CRS
    #[arg(long, value_enum, default_value_t, requires = "json")]
    pub coordinates: DumpCoordinates,
}
