//! What GDAL and PROJ say when something fails, as a text for users.

use std::cell::{Cell, RefCell};
use std::sync::Once;

use gdal::errors::{CplErrType, GdalError};

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
        Self { words }
    }
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
    LAST_WORDS.with_borrow_mut(|last| words.clone_into(last));
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
