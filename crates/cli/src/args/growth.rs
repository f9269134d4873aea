//! Arguments of `growth`: the packages, and the forms in which the table of growth is written.

use std::path::PathBuf;

use clap::{ArgGroup, Args, ValueHint};
use corniche_remote::PackagePlace;

use super::values::package_place;

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("files").args(["svg", "per_way"]).multiple(true))]
pub(crate) struct GrowthArgs {
    /// The package: a file, or an address on a web server (https://…); several are compared
    #[arg(value_name = "PACKAGE", required = true, value_parser = package_place(), value_hint = ValueHint::AnyPath)]
    pub(crate) packages: Vec<PackagePlace>,
    /// Print JSON, for programs
    #[arg(long, conflicts_with = "csv")]
    pub(crate) json: bool,
    /// Print CSV, for programs; of several packages with a column that names the package
    #[arg(long)]
    pub(crate) csv: bool,
    /// Also draw the growth over the levels (SVG): a line for each class, or for each of several packages
    #[arg(long, value_name = "FILE")]
    pub(crate) svg: Option<PathBuf>,
    /// Also write a line for each way (CSV): its length, and its vertices before and after on each level. Of one package
    #[arg(long, value_name = "CSV")]
    pub(crate) per_way: Option<PathBuf>,
    /// Replace files that exist, once the new ones are complete
    #[arg(short = 'O', long, requires = "files")]
    pub(crate) overwrite: bool,
}
