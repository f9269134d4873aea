//! Commands that concern the program and not a package.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

#[derive(Debug, Args)]
#[command(
    after_help = "For bash, for example: corniche completions bash > ~/.local/share/bash-completion/completions/corniche"
)]
pub(crate) struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    pub shell: Shell,
}

#[derive(Debug, Args)]
#[command(
    after_help = "For example: corniche layers railways > my.toml; then corniche layers my.toml checks the changed table, and corniche build --layers my.toml uses it"
)]
pub(crate) struct LayersArgs {
    /// The name of a built-in layer, whose table is printed, or the file of a table, which is
    /// checked; without it, the built-in layers are listed
    #[arg(value_name = "NAME|FILE")]
    pub layer: Option<String>,
    /// Print the JSON schema of tables, for editors
    #[arg(long, conflicts_with = "layer")]
    pub schema: bool,
}

#[derive(Debug, Args)]
#[command(
    after_help = "For example: corniche man ~/.local/share/man/man1; then read a page with man corniche-build"
)]
pub(crate) struct ManArgs {
    /// The folder to write the pages to; it is created if it does not exist
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
    /// Overwrite existing pages
    #[arg(short = 'O', long)]
    pub overwrite: bool,
}
