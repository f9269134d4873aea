//! The messages of GDAL and PROJ about failures, as texts for users.

use std::cell::{Cell, RefCell};
use std::env;
use std::sync::Once;

use gdal::errors::{CplErrType, GdalError};

use crate::proj_folders::NAMED_BY;

thread_local! {
    static LAST_WORDS: RefCell<String> = const { RefCell::new(String::new()) };
    /// Whether the last message was more than a warning.
    static HAS_FAILED: Cell<bool> = const { Cell::new(false) };
}

/// The reason that GDAL or PROJ gave for a failure, in its own words.
#[derive(Debug, thiserror::Error)]
#[error("{words}")]
pub struct LibraryError {
    words: String,
}

/// A longer text is a dump of definitions; its beginning says what happened.
const MOST_LETTERS: usize = 300;

/// What is said if the library says nothing.
const NO_REASON: &str = "GDAL gives no reason";

impl LibraryError {
    /// The reason of an error that was just returned on this thread.
    pub(crate) fn new(error: &GdalError) -> Self {
        let own = match error {
            GdalError::CplError { msg, .. } | GdalError::NullPointer { msg, .. } => msg.clone(),
            GdalError::BadArgument(text) => text.clone(),
            // This error is only a number; PROJ may have given the reason.
            GdalError::OgrError { .. } => String::new(),
            other => other.to_string(),
        };
        let heard = LAST_WORDS.with_borrow(String::clone);
        let words = [own, heard].into_iter().find(|words| !words.trim().is_empty());
        Self::quoted(words.as_deref().unwrap_or_default())
    }

    /// The words of the library, after its name.
    fn quoted(words: &str) -> Self {
        let words = Self::shortened(words.trim().trim_end_matches('.')).words;
        let words = if words.is_empty() { NO_REASON.to_owned() } else { words };
        let is_named = words.starts_with("GDAL") || words.starts_with("PROJ");
        let library = if words.starts_with("proj") { "PROJ" } else { "GDAL" };
        Self { words: if is_named { words } else { format!("{library}: {words}") } }
    }

    /// The reason of a failure that was found without the library.
    pub(crate) fn from_message(words: String) -> Self {
        Self { words }
    }

    fn shortened(words: &str) -> Self {
        let words = words.trim();
        let words = match words.char_indices().nth(MOST_LETTERS) {
            Some((end, _)) => format!("{} …", &words[..end]),
            None => words.to_owned(),
        };
        Self { words: with_advice(words, |name| env::var(name).ok()) }
    }
}

/// The message of the library, followed by advice if the message has none.
fn with_advice(words: String, variable: impl Fn(&str) -> Option<String>) -> String {
    // The second message means a database with other tables, or an empty one.
    if words.contains("proj.db") || words.contains("proj_create_from_database: SQLite error") {
        let set = NAMED_BY.into_iter().find_map(|name| Some((name, variable(name)?)));
        return match set {
            Some((name, value)) => format!(
                "{words}; {name} is set to {value:?}: unset it, or set it to the folder of the proj.db of this program's PROJ"
            ),
            None => words,
        };
    }
    if is_no_answer(&words) || words.starts_with(CURL_REASON) {
        return format!(
            "{words}; the server did not answer: it was not reached, or its certificate is not trusted (set SSL_CERT_FILE to a file of trusted \
             certificates; CURL_CA_BUNDLE has precedence)"
        );
    }
    words
}

/// The beginning of GDAL's message with the reason of curl.
const CURL_REASON: &str = "CURL error";

/// Whether this is GDAL's message for a server that did not answer: it has 0 instead of a status
/// code.
fn is_no_answer(words: &str) -> bool {
    words.contains("HTTP response code") && words.ends_with(": 0")
}

impl From<GdalError> for Box<LibraryError> {
    fn from(error: GdalError) -> Self {
        Box::new(LibraryError::new(&error))
    }
}

/// Keeps GDAL and PROJ from writing to standard error: their messages become part of errors.
pub fn quiet() {
    static QUIET: Once = Once::new();
    QUIET.call_once(|| gdal::config::set_error_handler(|kind, _, words| hear(kind, words)));
}

/// Stores a message of this thread, instead of letting GDAL print it.
fn hear(kind: CplErrType, words: &str) {
    LAST_WORDS.with_borrow_mut(|last| {
        // The reason of curl comes first, and says more than that the server did not answer.
        if !(is_no_answer(words) && last.starts_with(CURL_REASON)) {
            words.clone_into(last);
        }
    });
    if matches!(kind, CplErrType::Failure | CplErrType::Fatal) {
        HAS_FAILED.set(true);
    }
}

/// Deletes the stored message, so that the next failure is not explained by an earlier one.
pub fn forget() {
    LAST_WORDS.with_borrow_mut(String::clear);
    HAS_FAILED.set(false);
}

/// The last message on this thread, if any.
pub(crate) fn last_words() -> Option<String> {
    let words = LAST_WORDS.with_borrow(|words| LibraryError::shortened(words).words);
    (!words.is_empty()).then_some(words)
}

/// The failure that was reported on this thread, for calls that return none.
#[must_use]
pub fn failure() -> Option<Box<LibraryError>> {
    let said = || LAST_WORDS.with_borrow(|words| LibraryError::quoted(words));
    HAS_FAILED.get().then(|| Box::new(said()))
}

#[cfg(test)]
#[path = "library_error_tests.rs"]
mod tests;
