//! Arguments of `serve`: the packages, the address to listen at, and the folder for a static
//! site.

use std::path::PathBuf;

use clap::{Args, ValueHint};
use corniche_remote::PackagePlace;

use super::values::package_place;

#[derive(Debug, Args)]
#[command(
    after_help = "For example: corniche serve map.pmtiles --open. Without --open, open the address that the command prints. Ctrl-C stops the server, with exit code 0."
)]
pub(crate) struct ServeArgs {
    /// The packages: files. The page shows a single package, or a list to choose from
    #[arg(value_name = "PACKAGE", required = true, value_parser = package_place(), value_hint = ValueHint::FilePath)]
    pub packages: Vec<PackagePlace>,
    /// The address to listen at: an IP address or a name of this computer. By default only browsers
    /// on this computer can connect; 0.0.0.0 allows all that can reach it
    #[arg(long, value_name = "HOST", default_value = "127.0.0.1")]
    pub address: String,
    /// The port; 0 selects a free one
    #[arg(long, value_name = "N", default_value_t = 8080)]
    pub port: u16,
    /// Open the page in the browser of this computer: $BROWSER, or the system's default
    #[arg(long, conflicts_with = "site")]
    pub open: bool,
    /// The layers that the page shows at first, such as areas,railways; or none [default: all]
    #[arg(long, value_name = "NAMES|none")]
    pub layers: Option<String>,
    /// Use the page files in this folder [default: the built-in ones]
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub page: Option<PathBuf>,
    /// Start no server: write the page and packages to this folder, for any web server that
    /// supports range requests
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath, conflicts_with_all = ["address", "port"])]
    pub site: Option<PathBuf>,
    /// Overwrite a folder that --site wrote before, once the new one is complete
    #[arg(short = 'O', long, requires = "site")]
    pub overwrite: bool,
}
