//! Arguments of `serve`: the packages, the address to listen at, and the folder for a site of files.

use std::path::PathBuf;

use clap::{Args, ValueHint};
use corniche_remote::PackagePlace;

use super::values::package_place;

#[derive(Debug, Args)]
#[command(
    after_help = "For example: corniche serve map.pmtiles --open; or open the address that it prints. Ctrl-C ends it, with exit code 0."
)]
pub(crate) struct ServeArgs {
    /// The packages: files. The page shows one of them, or a list to choose from
    #[arg(value_name = "PACKAGE", required = true, value_parser = package_place(), value_hint = ValueHint::FilePath)]
    pub(crate) packages: Vec<PackagePlace>,
    /// Where to listen: an address of this computer, or its name. The default is for browsers on this computer alone; 0.0.0.0 is for
    /// all that reach it
    #[arg(long, value_name = "HOST", default_value = "127.0.0.1")]
    pub(crate) address: String,
    /// The port; 0 takes one that is free
    #[arg(long, value_name = "N", default_value_t = 8080)]
    pub(crate) port: u16,
    /// Open the page in the browser of this computer, which BROWSER names, else the system
    #[arg(long, conflicts_with = "site")]
    pub(crate) open: bool,
    /// Take the files of the page from this folder [default: those that the program was built with]
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub(crate) page: Option<PathBuf>,
    /// Serve nothing: write page and packages to this folder, for any web server that knows range requests
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath, conflicts_with_all = ["address", "port"])]
    pub(crate) site: Option<PathBuf>,
    /// Replace a folder that --site wrote before, once the new one is complete
    #[arg(short = 'O', long, requires = "site")]
    pub(crate) overwrite: bool,
}
