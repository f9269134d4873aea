//! The format of messages, for all commands.

use std::ffi::OsString;

use clap::{Arg, ArgAction, Args, ValueEnum};

/// The format of messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum LogFormat {
    /// Lines for people
    #[default]
    Text,
    /// One JSON object per line: time, level, message and fields
    Json,
}

// Which messages are written to standard error, and how; decided once, from the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Args)]
#[command(next_help_heading = "Messages")]
pub(crate) struct Voice {
    /// Print only errors and warnings on standard error. Standard output stays the same, except
    /// that verify prints only broken checks and the verdict
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Also print what is done and with which settings; -vv: each step, and messages of libraries
    #[arg(short, long, global = true, action = ArgAction::Count)]
    pub verbose: u8,
    /// Format of messages on standard error
    #[arg(long, global = true, value_enum, value_name = "FORMAT", default_value_t)]
    pub log_format: LogFormat,
    // Progress, warnings and the end of the run are records.
    #[arg(skip)]
    pub json_progress: bool,
}

impl Voice {
    /// The voice that an invalid command line requests: readers of records get the error as a
    /// record.
    pub(crate) fn of_unparsed(words: impl IntoIterator<Item = OsString>) -> Self {
        let mut voice = Self::default();
        let mut is_format = false;
        for word in words {
            let word = word.to_string_lossy();
            match &*word {
                // File names follow.
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

/// The option of commands that report progress.
pub(crate) fn json_progress() -> Arg {
    Arg::new(JSON_PROGRESS)
        .long("json-progress")
        .help("Print progress, warnings and the result on standard error, as one JSON object per line")
        .help_heading("Progress")
        .action(ArgAction::SetTrue)
        .conflicts_with("quiet")
}
