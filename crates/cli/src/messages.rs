//! What the program says: its answers on standard output, and on standard error notes, warnings and errors, as lines for people or as records for
//! programs.
//!
//! All of them are events of `tracing`; [`begin`] says which are shown and how. Standard error may be closed (`2>&1 | head`): then
//! nothing is said, and the work goes on.

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
    failure::Failure,
};

static VOICE: OnceLock<Voice> = OnceLock::new();
static BEGUN: OnceLock<Instant> = OnceLock::new();

/// Targets of our own events: names of crates, which begin so.
const OWN_TARGETS: &str = "corniche";

/// Target of a library that tells user names of addresses with its connections.
const TELLS_USER_NAMES: &str = "hyper_util";

/// Sets how messages are written, once, before the first one.
pub(crate) fn begin(voice: Voice) {
    let _ = VOICE.set(voice);
    let _ = BEGUN.set(Instant::now());
    let (own, libraries) = levels(voice);
    let shown = Targets::new()
        .with_target(OWN_TARGETS, own)
        .with_target(TELLS_USER_NAMES, libraries.min(LevelFilter::WARN))
        .with_default(libraries);
    let layer = fmt::layer().with_writer(|| Tolerant).with_ansi(false).log_internal_errors(false);
    // It can fail only if someone else was first, and nobody else is in this program.
    let _ = match voice.log_format {
        LogFormat::Text => tracing_subscriber::registry()
            .with(layer.event_format(Lines).with_filter(shown))
            .try_init(),
        LogFormat::Json => tracing_subscriber::registry()
            .with(layer.json().flatten_event(true).with_span_list(false).with_filter(shown))
            .try_init(),
    };
}

/// The least important events that are shown: ours, and those of libraries.
fn levels(voice: Voice) -> (LevelFilter, LevelFilter) {
    match voice {
        // Records of progress have their own form, and nothing comes between them.
        Voice { json_progress: true, .. } => (LevelFilter::OFF, LevelFilter::OFF),
        Voice { quiet: true, .. } => (LevelFilter::WARN, LevelFilter::OFF),
        Voice { verbose: 0, .. } => (LevelFilter::INFO, LevelFilter::OFF),
        Voice { verbose: 1, .. } => (LevelFilter::DEBUG, LevelFilter::WARN),
        Voice { .. } => (LevelFilter::TRACE, LevelFilter::DEBUG),
    }
}

/// How messages are written.
pub(crate) fn voice() -> Voice {
    VOICE.get().copied().unwrap_or_default()
}

/// Whether texts of several lines are for people who read along: neither silence nor records were asked for.
pub(crate) fn is_for_people() -> bool {
    let Voice { quiet, log_format, json_progress, .. } = voice();
    !quiet && !json_progress && log_format == LogFormat::Text
}

/// Whether people who read along want more than what matters most (`-v`).
pub(crate) fn is_detailed() -> bool {
    is_for_people() && voice().verbose > 0
}

/// Something good to know, in one line.
pub(crate) fn note(text: &str) {
    summary(&line(text));
}

/// Something good to know, in lines of ours. What others wrote stands in them as [`in_line`](crate::escaped::in_line) makes it.
pub(crate) fn summary(text: &str) {
    if !voice().json_progress {
        tracing::info!("{text}");
    }
}

/// Most characters of a message: all that our words need, and what others wrote as far as anyone reads it.
const MOST_SAID: usize = 8000;

/// A message of one line. Records for programs hold it as it is.
fn line(text: &str) -> Cow<'_, str> {
    match voice().log_format {
        LogFormat::Text => line_within(text, MOST_SAID),
        LogFormat::Json => Cow::Borrowed(text),
    }
}

/// Something that should be seen, also with `--quiet`.
pub(crate) fn warning(text: &str) {
    if voice().json_progress {
        write_line(&to_line(&ProgressRecord::Warning { warning: text }));
    } else {
        tracing::warn!("{}", line(text));
    }
}

/// Why something failed.
pub(crate) fn error(failure: &Failure) {
    if !voice().json_progress {
        tracing::error!(exit_code = failure.code().number(), "{}", line(&failure.to_string()));
    }
}

/// How the program ends: with `--json-progress` the last record, else the error, if there is one.
pub(crate) fn ended(code: ExitCode, failure: Option<&Failure>) {
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

/// Whether answers go to a terminal.
pub(crate) fn answers_are_seen() -> bool {
    io::stdout().is_terminal()
}

/// Whether notes, warnings and progress go to a terminal.
pub(crate) fn notes_are_seen() -> bool {
    io::stderr().is_terminal()
}

/// A line that is complete as it is, but for the secrets of addresses.
pub(crate) fn write_line(line: &str) {
    let _ = writeln!(io::stderr(), "{}", for_people(&without_secrets(line)));
}

/// Writes an answer for people, or a list, to standard output.
pub(crate) fn answer(text: &str) -> io::Result<()> {
    answer_as_it_is(for_people(text).as_bytes())
}

/// Writes a document for programs as a line of JSON, piece by piece.
pub(crate) fn answer_document(document: &impl Serialize) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
    write_line_to(&mut out, document)?;
    out.write_all(b"\n")?;
    out.flush()
}

/// Writes what programs read as it is, such as a script that we made.
pub(crate) fn answer_as_it_is(bytes: &[u8]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(bytes)?;
    out.flush()
}

/// Standard error, where it does not matter if nobody reads any more.
struct Tolerant;

impl Write for Tolerant {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // The library writes an event at once, so no character comes in two pieces. Whoever wrote the text, a library or a server that redirects.
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
