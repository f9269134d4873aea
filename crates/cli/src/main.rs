//! The `corniche` command: arguments, presets, progress, exit codes.
//!
//! This crate never holds an algorithm.

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
mod failure;
mod fly;
mod free_memory;
mod growth;
mod info;
mod interrupt;
mod jobs;
mod man;
mod matching;
mod merge;
mod messages;
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

use args::{Arguments, Command, LogFormat, Voice};
use exit::ExitCode;
use failure::Failure;

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

/// Help and version are answers, not errors; clap knows which stream each belongs on.
fn answer(error: &clap::Error) -> ExitCode {
    let voice = Voice::of_unparsed(env::args_os().skip(1));
    if error.use_stderr() && (voice.json_progress || voice.log_format == LogFormat::Json) {
        messages::begin(voice);
        messages::ended(ExitCode::Unusable, Some(&Failure::unusable(refusal(error))));
        return ExitCode::Unusable;
    }
    // If nobody reads it any more, the exit code alone must tell.
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

/// What the parser says of a command line, in one line, without its usage.
fn refusal(error: &clap::Error) -> String {
    let said = error.render().to_string();
    let paragraphs = said.split("\n\n").take_while(|paragraph| {
        !["Usage:", "For more information"].iter().any(|begin| paragraph.trim().starts_with(begin))
    });
    let words = paragraphs.flat_map(str::split_whitespace).collect::<Vec<_>>().join(" ");
    words.strip_prefix("error: ").unwrap_or(&words).to_owned()
}

fn run(arguments: Arguments) -> Result<ExitCode, Failure> {
    interrupt::watch()?;
    if arguments.die_with_parent {
        parent::watch()?;
    }
    open_files::allow_many();
    // Those that promise to stay within --memory.
    if matches!(arguments.command, Command::Build(_) | Command::Part(_) | Command::Merge(_)) {
        free_memory::give_back_early();
    }
    match arguments.command {
        Command::Build(args) => build::run(args),
        Command::Plan(args) => plan::run(*args),
        Command::Jobs(args) => jobs::run(&args),
        Command::Part(args) => part::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Growth(args) => growth::run(&args),
        Command::Profile(args) => profile::run(&args),
        Command::Match(args) => matching::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Tile(args) => tile::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Render(args) => render::run(&args),
        Command::Fly(args) => fly::run(&args),
        Command::View(args) => view::run(&args),
        Command::Serve(args) => serve::run(&args),
        Command::Completions(args) => completions::run(&args),
        Command::Man(args) => man::run(&args),
    }
}
