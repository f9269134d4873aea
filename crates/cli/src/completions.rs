//! `corniche completions`: prints a completion script for a shell.

use clap::CommandFactory as _;

use crate::{
    args::{Arguments, CompletionsArgs},
    failure::Result,
    messages,
};

pub(crate) fn run(args: &CompletionsArgs) -> Result<()> {
    // The generator panics if it cannot write, so it writes to memory.
    let mut script = Vec::new();
    let mut command = Arguments::command();
    let name = command.get_name().to_owned();
    clap_complete::generate(args.shell, &mut command, name, &mut script);
    Ok(messages::answer_as_it_is(&script)?)
}
