//! What GDAL and PROJ say when something fails, as a text for users.

use std::cell::{Cell, RefCell};
use std::env;
use std::sync::Once;

use gdal::errors::{CplErrType, GdalError};

use crate::proj_folders::NAMED_BY;

thread_local! {
    static LAST_WORDS: RefCell<String> = const { RefCell::new(String::new()) };
    /// Whether it was more than a warning.
    static HAS_FAILED: Cell<bool> = const { Cell::new(false) };
}

/// The reason that GDAL or PROJ gave for a failure, in its own words.
#[derive(Debug, thiserror::Error)]
#[error("{words}")]
pub struct LibraryError {
    words: String,
}

/// Text longer than this is a dump of definitions; its beginning says what happened.
const MOST_LETTERS: usize = 300;

impl LibraryError {
    /// Tells of an error that was just returned on this thread.
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
        Self::shortened(words.as_deref().unwrap_or("GDAL gives no reason"))
    }

    /// Says what was found out about a failure without the library.
    pub(crate) fn of(words: String) -> Self {
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

/// What the libraries say, and after it what to do, where they leave that out.
fn with_advice(words: String, variable: impl Fn(&str) -> Option<String>) -> String {
    // The second is said of a database that has other tables, or none.
    if words.contains("proj.db") || words.contains("proj_create_from_database: SQLite error") {
        let set = NAMED_BY.into_iter().find_map(|name| Some((name, variable(name)?)));
        return match set {
            Some((name, value)) => format!(
                "{words}; {name} is set to {value:?}: unset it, or let it name the tables of this program's PROJ"
            ),
            None => words,
        };
    }
    if is_no_answer(&words) || words.starts_with(CURL_REASON) {
        return format!(
            "{words}; there was no answer: the server was not reached, or its certificate is not trusted (SSL_CERT_FILE names a file of \
             certificates that are; CURL_CA_BUNDLE has precedence)"
        );
    }
    words
}

/// How GDAL begins when it tells curl's reason.
const CURL_REASON: &str = "CURL error";

/// Whether this is what GDAL says where a server gave no answer: 0 in the place of the answer's
/// status.
fn is_no_answer(words: &str) -> bool {
    words.contains("HTTP response code") && words.ends_with(": 0")
}

impl From<GdalError> for Box<LibraryError> {
    fn from(error: GdalError) -> Self {
        Box::new(LibraryError::new(&error))
    }
}

/// Keeps GDAL and PROJ from writing to standard error: what they say comes back in errors.
pub fn quiet() {
    static QUIET: Once = Once::new();
    QUIET.call_once(|| gdal::config::set_error_handler(|kind, _, words| hear(kind, words)));
}

/// Remembers what was said on this thread, in the place of GDAL's printing it.
fn hear(kind: CplErrType, words: &str) {
    LAST_WORDS.with_borrow_mut(|last| {
        // Curl's reason comes first, and says more than that there was no answer.
        if !(is_no_answer(words) && last.starts_with(CURL_REASON)) {
            words.clone_into(last);
        }
    });
    if matches!(kind, CplErrType::Failure | CplErrType::Fatal) {
        HAS_FAILED.set(true);
    }
}

/// Forgets what was said, so that the next failure is not explained by an earlier one.
pub fn forget() {
    LAST_WORDS.with_borrow_mut(String::clear);
    HAS_FAILED.set(false);
}

/// What was said last on this thread, if anything was.
pub(crate) fn last_words() -> Option<String> {
    let words = LAST_WORDS.with_borrow(|words| LibraryError::shortened(words).words);
    (!words.is_empty()).then_some(words)
}

/// The failure that was told on this thread, for calls that return none.
#[must_use]
pub fn failure() -> Option<Box<LibraryError>> {
    let said = || LAST_WORDS.with_borrow(|words| LibraryError::shortened(words));
    HAS_FAILED.get().then(|| Box::new(said()))
}

#[cfg(test)]
#[path = "library_error_tests.rs"]
mod tests;
