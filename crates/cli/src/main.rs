//! The `corniche` command: arguments, presets, progress, exit codes.
//!
//! This crate never holds an algorithm.

#![expect(clippy::print_stderr, reason = "the command talks to people on standard error")]

mod args;
mod build;
mod chart;
mod defects;
mod exit;
mod export;
mod failure;
mod fly;
mod free_memory;
mod growth;
mod info;
mod interrupt;
mod jobs;
mod merge;
mod named_output;
mod open_files;
mod output;
mod parent;
mod part;
mod plan;
mod presets;
mod progress;
mod render;
mod settings;
mod styles;
mod table;
mod tile;
mod verify;
mod view;

use std::process;

use clap::Parser;

use args::{Arguments, Command};
use exit::ExitCode;
use failure::Failure;

fn main() -> process::ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are answers, not errors; clap knows which stream each belongs on.
            let code = if error.use_stderr() { ExitCode::Unusable } else { ExitCode::Done };
            let _ = error.print();
            return code.into();
        }
    };
    match run(arguments) {
        Ok(code) => code.into(),
        Err(failure) => {
            let failure = interrupt::explain(failure);
            if !failure.is_closed_pipe() {
                failure.tell();
            }
            failure.code().into()
        }
    }
}

fn run(arguments: Arguments) -> Result<ExitCode, Failure> {
    interrupt::watch()?;
    open_files::allow_many();
    free_memory::give_back_early();
    match arguments.command {
        Command::Build(args) => build::run(args),
        Command::Plan(args) => plan::run(*args),
        Command::Jobs(args) => jobs::run(&args),
        Command::Part(args) => part::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Growth(args) => growth::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Tile(args) => tile::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Render(args) => render::run(&args),
        Command::Fly(args) => fly::run(&args),
        Command::View(args) => view::run(&args),
    }
}
