//! `corniche completions`: a script for a shell.

use clap::CommandFactory as _;

use crate::{
    args::{Arguments, CompletionsArgs},
    exit::ExitCode,
    failure::Failure,
    messages,
};

pub(crate) fn run(args: &CompletionsArgs) -> Result<ExitCode, Failure> {
    // The generator panics when it cannot write, so it writes to memory.
    let mut script = Vec::new();
    let mut command = Arguments::command();
    let name = command.get_name().to_owned();
    clap_complete::generate(args.shell, &mut command, name, &mut script);
    messages::answer_as_it_is(&script)?;
    Ok(ExitCode::Done)
}
