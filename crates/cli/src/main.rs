//! The `corniche` command: arguments, presets, progress, exit codes.
//!
//! This crate never holds an algorithm.

#[macro_use]
mod failure;
#[macro_use]
mod messages;

mod args;
mod build;
mod chart;
mod completions;
mod credits;
mod defects;
mod documents;
mod drawing;
mod escaped;
mod exit;
mod export;
mod fly;
mod free_memory;
mod growth;
mod info;
mod interrupt;
mod jobs;
mod layers;
mod man;
mod matching;
mod merge;
mod names;
mod open_files;
mod output;
mod overlays;
mod packages;
mod parent;
mod part;
mod plan;
mod presets;
mod profile;
mod progress;
mod quiet_libraries;
mod recorded;
mod render;
mod serve;
mod settings;
mod styles;
mod table;
mod tile;
mod verdict;
mod verify;
mod version;
mod view;
mod view_command;

use std::{env, process};

use clap::error::ErrorKind;
use corniche_remote::without_secrets;

use args::{Arguments, CliCommand, LogFormat, Voice};
use exit::ExitCode;
use failure::{CommandFailure, Result};

fn main() -> process::ExitCode {
    if let Ok(program) = env::current_exe() {
        corniche_gis::use_files_beside(&program);
    }
    let arguments = match Arguments::checked_from(env::args_os()) {
        Ok(arguments) => arguments,
        Err(error) => return answer(&error).into(),
    };
    if arguments.command.draws() {
        quiet_libraries::begin();
    }
    messages::begin(arguments.voice);
    let _span = tracing::info_span!("corniche", command = arguments.name).entered();
    tracing::debug!(
        version = env!("CARGO_PKG_VERSION"),
        libraries = corniche_gis::libraries(),
        "begins"
    );
    let (code, failure) = match run(arguments) {
        Ok(code) => (code, None),
        Err(failure) => {
            let failure = interrupt::explain(failure);
            (failure.code(), (!failure.is_closed_pipe()).then_some(failure))
        }
    };
    packages::tell_requests();
    messages::ended(code, failure.as_ref());
    code.into()
}

/// Prints help or version, which are no errors; clap selects the stream.
fn answer(error: &clap::Error) -> ExitCode {
    let voice = Voice::of_unparsed(env::args_os().skip(1));
    if error.use_stderr() && (voice.json_progress || voice.log_format == LogFormat::Json) {
        messages::begin(voice);
        messages::ended(ExitCode::Unusable, Some(&CommandFailure::unusable(refusal(error))));
        return ExitCode::Unusable;
    }
    // If nobody reads the stream, only the exit code is left.
    if error.kind() == ErrorKind::DisplayVersion && version::is_long_asked_for() {
        let _ = version::print_long();
    } else {
        let said = error.render().to_string();
        let is_shown_as_it_is = escaped::for_people(&said) == said
            && (!error.use_stderr() || without_secrets(&said) == said);
        if is_shown_as_it_is {
            let _ = error.print();
        } else if error.use_stderr() {
            messages::write_line(said.trim_end());
        } else {
            let _ = messages::answer(&said);
        }
    }
    if error.use_stderr() { ExitCode::Unusable } else { ExitCode::Done }
}

/// The parser's error message in one line, without the usage.
fn refusal(error: &clap::Error) -> String {
    let said = error.render().to_string();
    let paragraphs = said.split("\n\n").take_while(|paragraph| {
        !["Usage:", "For more information"].iter().any(|begin| paragraph.trim().starts_with(begin))
    });
    let words = paragraphs.flat_map(str::split_whitespace).collect::<Vec<_>>().join(" ");
    words.strip_prefix("error: ").unwrap_or(&words).to_owned()
}

fn run(arguments: Arguments) -> Result<ExitCode> {
    interrupt::watch()?;
    if arguments.die_with_parent {
        parent::watch()?;
    }
    open_files::allow_many();
    // Commands that promise to stay within --memory.
    if matches!(
        arguments.command,
        CliCommand::Build(_) | CliCommand::Part(_) | CliCommand::Merge(_)
    ) {
        free_memory::give_back_early();
    }
    match arguments.command {
        // Commands that also report a result by their exit code.
        CliCommand::Verify(args) => return verify::run(&args),
        CliCommand::View(args) => return view::run(&args),
        CliCommand::Build(args) => build::run(args),
        CliCommand::Plan(args) => plan::run(*args),
        CliCommand::Jobs(args) => jobs::run(&args),
        CliCommand::Part(args) => part::run(&args),
        CliCommand::Merge(args) => merge::run(&args),
        CliCommand::Info(args) => info::run(&args),
        CliCommand::Growth(args) => growth::run(&args),
        CliCommand::Profile(args) => profile::run(&args),
        CliCommand::Match(args) => matching::run(&args),
        CliCommand::Tile(args) => tile::run(&args),
        CliCommand::Export(args) => export::run(&args),
        CliCommand::Layers(args) => layers::run(&args),
        CliCommand::Render(args) => render::run(&args),
        CliCommand::Fly(args) => fly::run(&args),
        CliCommand::Serve(args) => serve::run(&args),
        CliCommand::Completions(args) => completions::run(&args),
        CliCommand::Man(args) => man::run(&args),
    }?;
    Ok(ExitCode::Done)
}
