//! What belongs to the program and to no package.

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
    pub(crate) shell: Shell,
}

#[derive(Debug, Args)]
#[command(
    after_help = "For example: corniche man ~/.local/share/man/man1; then man corniche-build shows a page"
)]
pub(crate) struct ManArgs {
    /// The folder to write them in; it is made if it does not exist
    #[arg(value_name = "FOLDER")]
    pub(crate) folder: PathBuf,
    /// Replace pages that exist
    #[arg(short = 'O', long)]
    pub(crate) overwrite: bool,
}
