//! Arguments of `match`: what roads are compared with, how far to search, and what to write.

use std::path::PathBuf;

use clap::{ArgGroup, Args, ValueHint};
use corniche_remote::PackagePlace;

use super::{
    shared::ClassesArg,
    values::{package_place, parse_within},
    voice::json_progress,
};
#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    group = ArgGroup::new("target").args(["photo", "slope"]).required(true),
    override_usage = "corniche match [OPTIONS] <--photo <FILE>...|--slope> <PACKAGE>",
    group = ArgGroup::new("written").args(["csv", "svg"]).multiple(true),
    mut_arg("classes", |arg| arg.help("Functional road classes (FRC) to compare, such as 0-4,7")),
)]
pub(crate) struct MatchArgs {
    /// The package: a file, or a URL (https://…)
    #[arg(required_unless_present = "photo", value_parser = package_place(), value_hint = ValueHint::AnyPath)]
    pub package: Option<PackagePlace>,
    /// Photos of the ground to compare roads with, as for build --photo: any format and CRS that
    /// GDAL reads; the first is on top
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub photo: Vec<PathBuf>,
    /// Allow PROJ's ballpark transformations (no datum shift) for photos; they can then be off by
    /// 100 m or more
    #[arg(long, requires = "photo")]
    pub allow_ballpark: bool,
    /// Compare with the slope of the ground: roads are level across. For packages with relief, from
    /// lidar with samples of a few metres
    #[arg(long)]
    pub slope: bool,
    /// How far from roads to search, metres, 1 to 500
    #[arg(long, value_name = "METRES", default_value_t = 30.0, value_parser = |text: &str| metres(text, 500.0))]
    pub radius: f64,
    /// The side of the squares for which offsets are reported, metres
    #[arg(long, value_name = "METRES", default_value_t = 2000.0, value_parser = |text: &str| metres(text, 1e6))]
    pub region: f64,
    #[command(flatten)]
    pub filter: ClassesArg,
    /// Also write one line per way (CSV)
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Also draw a map of the offsets (SVG)
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Overwrite existing files, once the new ones are complete
    #[arg(short = 'O', long, requires = "written")]
    pub overwrite: bool,
}

/// Parses a number of metres from 1 to `most`.
fn metres(text: &str, most: f64) -> Result<f64, String> {
    parse_within(text, 1.0..=most, &format!("write a number of metres from 1 to {most}"))
}
