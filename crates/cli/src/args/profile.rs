//! Arguments of `profile`: the ways or lines to follow, and what to write of them.

use std::path::PathBuf;

use clap::{ArgGroup, Args, ValueHint};
use corniche_remote::PackagePlace;

use super::values::package_place;

#[derive(Debug, Args)]
#[command(
    group = ArgGroup::new("drawn").args(["csv", "svg"]).multiple(true),
    group = ArgGroup::new("what").args(["way", "line"]).required(true),
)]
pub(crate) struct ProfileArgs {
    /// The package: a file, or an address on a web server (https://…)
    #[arg(value_parser = package_place(), value_hint = ValueHint::AnyPath)]
    pub(crate) package: PackagePlace,
    /// The ways to follow, by their ids in OSM, in this order; each is turned so that it goes on where the one before it ends
    #[arg(long, value_name = "ID", value_delimiter = ',', allow_negative_numbers = true)]
    pub(crate) way: Vec<i64>,
    /// The lines to follow instead: those of a file (GeoJSON, GPX, GeoPackage, Shapefile …), one after the other
    #[arg(long, value_name = "FILE")]
    pub(crate) line: Option<PathBuf>,
    /// The level on whose ground they lie [default: the finest]
    #[arg(long, value_name = "Z")]
    pub(crate) level: Option<u8>,
    /// Also write a line for each vertex (CSV)
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Also draw height and grade over distance (SVG)
    #[arg(long, value_name = "FILE")]
    pub(crate) svg: Option<PathBuf>,
    /// Replace files that exist, once the new ones are complete
    #[arg(short = 'O', long, requires = "drawn")]
    pub(crate) overwrite: bool,
}
