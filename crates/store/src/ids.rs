//! Unique ids, and the line by which Corniche recognises its own files: a mark and an id.

use std::hash::{BuildHasher as _, Hasher as _, RandomState};

/// Number of digits of an id.
const DIGITS: usize = 16;

/// Returns sixteen hexadecimal digits that have never been used before.
#[must_use]
pub fn random_digits() -> String {
    // Each `RandomState` has new keys from the system.
    format!("{:0DIGITS$x}", RandomState::new().build_hasher().finish())
}

/// Whether a text can be a result of [`random_digits`].
pub(crate) fn is_id(text: &str) -> bool {
    text.len() == DIGITS && is_hexadecimal(text)
}

/// The content of a file whose first line should be a mark and an id.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Marked<'a> {
    /// The id, and the text after its line.
    Id(&'a str, &'a str),
    /// Nothing, or an incomplete first line, left by a kill or by a full disk: there are no files
    /// yet that belong to this id.
    Begun,
    /// Something that Corniche did not write.
    Other,
}

/// Reads the first line of a file.
pub(crate) fn marked<'a>(text: &'a str, mark: &str) -> Marked<'a> {
    let Some(after) = text.strip_prefix(mark) else {
        return if mark.starts_with(text) { Marked::Begun } else { Marked::Other };
    };
    match after.split_once('\n') {
        Some((id, rest)) if is_id(id) => Marked::Id(id, rest),
        None if after.len() <= DIGITS && is_hexadecimal(after) => Marked::Begun,
        _ => Marked::Other,
    }
}

fn is_hexadecimal(text: &str) -> bool {
    text.bytes().all(|c| c.is_ascii_hexdigit())
}

#[cfg(test)]
#[path = "ids_tests.rs"]
mod tests;
