//! Commands that tell what a package holds.

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
/// What `verify --help` ends with: the checks, by their ids.
fn checks() -> String {
    let mut text =
        "The last line is the verdict; with --quiet only it and broken checks are printed.\n\n\
         Checks (docs/promises.md explains them); a broken one makes exit code 1:\n"
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
    pub(crate) from: PackageArg,
    /// Print JSON, for programs
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
#[command(arg = json_progress(), after_long_help = checks(), override_usage = "corniche verify [OPTIONS] <PACKAGE>")]
pub(crate) struct VerifyArgs {
    /// The package: a file, or an address on a web server (https://…)
    #[arg(required_unless_present_any = ["dem", "photo", "osm"], value_parser = package_place(), value_hint = ValueHint::AnyPath)]
    pub(crate) package: Option<PackagePlace>,
    /// The elevation rasters it was made from, in the same order: checks stored errors against true ones
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub(crate) dem: Vec<PathBuf>,
    /// The photos it was made from, in the same order: reads them again and checks the photo of every tile against them
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub(crate) photo: Vec<PathBuf>,
    /// The extracts it was made from: reads them again and checks roads, attributes and counts against them
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub(crate) osm: Vec<PathBuf>,
    /// With --dem or --osm: the polygon that it was cut with
    #[arg(long, value_name = "FILE")]
    pub(crate) polygon: Option<PathBuf>,
    /// With --osm: the FRC table it was made with [default: the preset of the recorded name]
    #[arg(long, value_name = "NAME|FILE", requires = "osm")]
    pub(crate) frc_table: Option<String>,
    /// With --osm: the table of areas it was made with [default: the preset of the recorded name]
    #[arg(long, value_name = "NAME|FILE", requires = "osm")]
    pub(crate) areas: Option<String>,
    #[command(flatten)]
    pub(crate) cpu: ThreadsArg,
    /// Print JSON, for programs
    #[arg(long)]
    pub(crate) json: bool,
}

/// What the coordinates in a dump are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum Coordinates {
    /// Working metres: the CRS's coordinates times the package's `metres_per_unit`
    #[default]
    Working,
    /// The package's CRS: degrees, feet or metres; longitudes may run on past 180
    Crs,
}

#[derive(Debug, Args)]
pub(crate) struct TileArgs {
    #[command(flatten)]
    pub(crate) from: PackageArg,
    /// The tile: level, column from the west, row from the north
    #[arg(value_name = "Z/X/Y", required_unless_present = "at")]
    pub(crate) id: Option<TileId>,
    /// The finest tile at this longitude and latitude (degrees, WGS84), in place of Z/X/Y
    #[arg(long, value_name = "LON,LAT", value_parser = parse_position, allow_hyphen_values = true, conflicts_with = "id")]
    pub(crate) at: Option<[f64; 2]>,
    /// With --at: the tile of this level
    #[arg(long, value_name = "Z", requires = "at", conflicts_with = "id")]
    pub(crate) level: Option<u8>,
    /// Print all that the tile holds as JSON, for programs: ground with normals, roads, attributes; in working metres
    #[arg(long)]
    pub(crate) json: bool,
    /// What x and y in the JSON are: working metres, or coordinates of the package's CRS
    #[arg(long, value_enum, default_value_t, requires = "json")]
    pub(crate) coordinates: Coordinates,
}
