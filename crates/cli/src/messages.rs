//! The output of the program: results on standard output; notes, warnings and errors on
//! standard error, as lines for people or as records for programs.
//!
//! All messages are events of `tracing`; [`begin`] decides which are shown and how. If standard
//! error is closed (`2>&1 | head`), messages are dropped and the work continues.

mod lines;

use std::{
    borrow::Cow,
    io::{self, BufWriter, IsTerminal, Write},
    sync::OnceLock,
    time::Instant,
};

use corniche_remote::without_secrets;
use serde::Serialize;
use tracing::level_filters::LevelFilter;
use tracing_subscriber::{
    Layer as _, filter::Targets, fmt, layer::SubscriberExt as _, util::SubscriberInitExt as _,
};

use self::lines::Lines;
use crate::{
    args::{LogFormat, Voice},
    documents::{
        progress::{EndRecord, ProgressRecord},
        to_line, write_line_to,
    },
    escaped::{for_people, in_json, line_within},
    exit::ExitCode,
    failure::CommandFailure,
};

static VOICE: OnceLock<Voice> = OnceLock::new();
static BEGUN: OnceLock<Instant> = OnceLock::new();

/// Target prefix of our own events: the common prefix of our crates' names.
const OWN_TARGETS: &str = "corniche";

/// Target of a library that logs the user names of URLs with its connections.
const TELLS_USER_NAMES: &str = "hyper_util";

/// Sets the format of messages, once, before the first message.
pub(crate) fn begin(voice: Voice) {
    let _ = VOICE.set(voice);
    let _ = BEGUN.set(Instant::now());
    let (own, libraries) = levels(voice);
    let shown = Targets::new()
        .with_target(OWN_TARGETS, own)
        .with_target(TELLS_USER_NAMES, libraries.min(LevelFilter::WARN))
        .with_default(libraries);
    let layer = fmt::layer().with_writer(|| Tolerant).with_ansi(false).log_internal_errors(false);
    // This fails only if another subscriber is registered, which does not happen in this program.
    let _ = match voice.log_format {
        LogFormat::Text => tracing_subscriber::registry()
            .with(layer.event_format(Lines).with_filter(shown))
            .try_init(),
        LogFormat::Json => tracing_subscriber::registry()
            .with(layer.json().flatten_event(true).with_span_list(false).with_filter(shown))
            .try_init(),
    };
}

/// The lowest levels of shown events: ours, and those of libraries.
fn levels(voice: Voice) -> (LevelFilter, LevelFilter) {
    match voice {
        // Progress records have their own format, and no other output may be between them.
        Voice { json_progress: true, .. } => (LevelFilter::OFF, LevelFilter::OFF),
        Voice { quiet: true, .. } => (LevelFilter::WARN, LevelFilter::OFF),
        Voice { verbose: 0, .. } => (LevelFilter::INFO, LevelFilter::OFF),
        Voice { verbose: 1, .. } => (LevelFilter::DEBUG, LevelFilter::WARN),
        Voice { .. } => (LevelFilter::TRACE, LevelFilter::DEBUG),
    }
}

/// The format of messages.
pub(crate) fn voice() -> Voice {
    VOICE.get().copied().unwrap_or_default()
}

/// Whether texts of several lines are for people who read along: neither `--quiet` nor records are
/// requested.
pub(crate) fn is_for_people() -> bool {
    let Voice { quiet, log_format, json_progress, .. } = voice();
    !quiet && !json_progress && log_format == LogFormat::Text
}

/// Whether details are requested for people (`-v`).
pub(crate) fn is_detailed() -> bool {
    is_for_people() && voice().verbose > 0
}

/// Prints a note, in words like those of `format!`.
macro_rules! note {
    ($($words:tt)+) => { $crate::messages::note(&format!($($words)+)) };
}

/// Prints a warning, in words like those of `format!`.
macro_rules! warning {
    ($($words:tt)+) => { $crate::messages::warning(&format!($($words)+)) };
}

/// Prints a note of one line.
pub(crate) fn note(text: &str) {
    summary(&line(text));
}

/// Prints a note of our own lines. Foreign values in it must be escaped with
/// [`in_line`](crate::escaped::in_line).
pub(crate) fn summary(text: &str) {
    if !voice().json_progress {
        tracing::info!("{text}");
    }
}

/// The largest number of characters in a message: enough for all of our texts, and for foreign
/// texts as far as anyone reads them.
const MOST_SAID: usize = 8000;

/// The message as one line. Records for programs contain the unchanged text.
fn line(text: &str) -> Cow<'_, str> {
    match voice().log_format {
        LogFormat::Text => line_within(text, MOST_SAID),
        LogFormat::Json => Cow::Borrowed(text),
    }
}

/// Prints a warning, also with `--quiet`.
pub(crate) fn warning(text: &str) {
    if voice().json_progress {
        write_line(&to_line(&ProgressRecord::Warning { warning: text }));
    } else {
        tracing::warn!("{}", line(text));
    }
}

/// Prints the reason of a failure.
pub(crate) fn error(failure: &CommandFailure) {
    if !voice().json_progress {
        tracing::error!(exit_code = failure.code().number(), "{}", line(&failure.to_string()));
    }
}

/// Reports the end of the program: with `--json-progress` the last record, otherwise the error, if
/// there is one.
pub(crate) fn ended(code: ExitCode, failure: Option<&CommandFailure>) {
    if voice().json_progress {
        let end = EndRecord {
            result: code,
            exit_code: code.number(),
            error: failure.map(ToString::to_string),
            seconds: BEGUN.get().map_or(0.0, |begun| begun.elapsed().as_secs_f64()),
        };
        write_line(&to_line(&ProgressRecord::End { end }));
    } else if let Some(failure) = failure {
        error(failure);
    }
}

/// Whether standard output is a terminal.
pub(crate) fn answers_are_seen() -> bool {
    io::stdout().is_terminal()
}

/// Whether standard error, and with it notes, warnings and progress, is a terminal.
pub(crate) fn notes_are_seen() -> bool {
    io::stderr().is_terminal()
}

/// Writes a complete line, from which only the secrets in URLs are removed.
pub(crate) fn write_line(line: &str) {
    let _ = writeln!(io::stderr(), "{}", for_people(&without_secrets(line)));
}

/// Writes a text for people, or a list, to standard output.
pub(crate) fn answer(text: &str) -> io::Result<()> {
    answer_as_it_is(for_people(text).as_bytes())
}

/// Writes a document for programs as a line of JSON, streaming it.
pub(crate) fn answer_document(document: &impl Serialize) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
    write_line_to(&mut out, document)?;
    out.write_all(b"\n")?;
    out.flush()
}

/// Writes output for programs unchanged, such as a generated script.
pub(crate) fn answer_as_it_is(bytes: &[u8]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(bytes)?;
    out.flush()
}

/// Standard error; failures to write are ignored, because nobody may be reading.
struct Tolerant;

impl Write for Tolerant {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // The library writes each event in a single call, so no character is split. The text may
        // come from a library or from a server that redirects.
        let text = String::from_utf8_lossy(bytes);
        let text = without_secrets(&text);
        let text = match voice().log_format {
            LogFormat::Text => for_people(&text),
            LogFormat::Json => in_json(&text),
        };
        let _ = io::stderr().write_all(text.as_bytes());
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
#[path = "messages_tests.rs"]
mod tests;
