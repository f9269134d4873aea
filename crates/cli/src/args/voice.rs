//! How messages are written, for all commands.

use std::ffi::OsString;

use clap::{Arg, ArgAction, Args, ValueEnum};

/// How messages are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum LogFormat {
    /// Lines for people
    #[default]
    Text,
    /// One JSON object per line: time, level, message and fields
    Json,
}

// What messages are written on standard error, and how; decided once, from the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Args)]
#[command(next_help_heading = "Messages")]
pub(crate) struct Voice {
    /// Print only errors and warnings on standard error; what a command is asked to print stays (of verify: what is broken, and the
    /// verdict)
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Tell also what is done and with which settings; -vv: each step, and what libraries say
    #[arg(short, long, global = true, action = ArgAction::Count)]
    pub(crate) verbose: u8,
    /// How messages are written on standard error
    #[arg(long, global = true, value_enum, value_name = "FORMAT", default_value_t)]
    pub(crate) log_format: LogFormat,
    // Progress is records, and with it warnings and how the run ended.
    #[arg(skip)]
    pub(crate) json_progress: bool,
}

impl Voice {
    /// The voice that a command line asks for which cannot be parsed: whoever reads records gets the refusal as a record.
    pub(crate) fn of_unparsed(words: impl IntoIterator<Item = OsString>) -> Self {
        let mut voice = Self::default();
        let mut is_format = false;
        for word in words {
            let word = word.to_string_lossy();
            match &*word {
                // Names of files follow.
                "--" => break,
                "json" if is_format => voice.log_format = LogFormat::Json,
                "--log-format=json" => voice.log_format = LogFormat::Json,
                "--json-progress" => voice.json_progress = true,
                _ => {}
            }
            is_format = word == "--log-format";
        }
        voice
    }
}

/// The id of `--json-progress`.
pub(crate) const JSON_PROGRESS: &str = "json_progress";

/// The option of commands that tell progress.
pub(crate) fn json_progress() -> Arg {
    Arg::new(JSON_PROGRESS)
        .long("json-progress")
        .help("Print progress, warnings and the end on standard error, as one JSON object per line")
        .help_heading("Progress")
        .action(ArgAction::SetTrue)
        .conflicts_with("quiet")
}
