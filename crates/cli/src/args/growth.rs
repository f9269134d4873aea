//! Arguments of `growth`: the packages, and the output formats of the growth table.

use std::path::PathBuf;

use clap::{ArgGroup, Args, ValueHint};
use corniche_remote::PackagePlace;

use super::values::package_place;

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("files").args(["svg", "per_way"]).multiple(true))]
pub(crate) struct GrowthArgs {
    /// The package: a file, or a URL (https://…); several packages are compared
    #[arg(value_name = "PACKAGE", required = true, value_parser = package_place(), value_hint = ValueHint::AnyPath)]
    pub packages: Vec<PackagePlace>,
    /// Print JSON, for programs
    #[arg(long, conflicts_with = "csv")]
    pub json: bool,
    /// Print CSV, for programs; with several packages, a column names the package
    #[arg(long)]
    pub csv: bool,
    /// Also draw the growth over the levels (SVG): one line per class, or per package if there are
    /// several
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Also write one line per way (CSV): its length, and its vertices before and after clipping on
    /// each level. Only for a single package
    #[arg(long, value_name = "CSV")]
    pub per_way: Option<PathBuf>,
    /// Overwrite existing files, once the new ones are complete
    #[arg(short = 'O', long, requires = "files")]
    pub overwrite: bool,
}
