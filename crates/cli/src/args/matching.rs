//! Arguments of `match`: what roads are compared with, how far beside them to look, and what to write.

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
    mut_arg("classes", |arg| arg.help("Functional road classes that are compared, such as 0-4,7")),
)]
pub(crate) struct MatchArgs {
    /// The package: a file, or an address on a web server (https://…)
    #[arg(required_unless_present = "photo", value_parser = package_place(), value_hint = ValueHint::AnyPath)]
    pub(crate) package: Option<PackagePlace>,
    /// Photos of the ground that roads are compared with, as for build --photo: any format and CRS that GDAL reads; the first lies on top
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub(crate) photo: Vec<PathBuf>,
    /// Take the datum of photos for that of the package where PROJ knows nothing between them; photos can then lie 100 m and more beside it
    #[arg(long, requires = "photo")]
    pub(crate) allow_ballpark: bool,
    /// Compare with the slope of the ground, in which roads are flat across; for lidar of some metres, of a package with relief
    #[arg(long)]
    pub(crate) slope: bool,
    /// How far beside roads to look, metres, 1 to 500
    #[arg(long, value_name = "METRES", default_value_t = 30.0, value_parser = |text: &str| metres(text, 500.0))]
    pub(crate) radius: f64,
    /// The side of the squares for which offsets are told, metres
    #[arg(long, value_name = "METRES", default_value_t = 2000.0, value_parser = |text: &str| metres(text, 1e6))]
    pub(crate) region: f64,
    #[command(flatten)]
    pub(crate) filter: ClassesArg,
    /// Also write a line for each way (CSV)
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Also draw a map of the offsets (SVG)
    #[arg(long, value_name = "FILE")]
    pub(crate) svg: Option<PathBuf>,
    /// Replace files that exist, once the new ones are complete
    #[arg(short = 'O', long, requires = "written")]
    pub(crate) overwrite: bool,
}

/// A number of metres from 1 to the most.
fn metres(text: &str, most: f64) -> Result<f64, String> {
    parse_within(text, 1.0..=most, &format!("write metres from 1 to {most}"))
}
