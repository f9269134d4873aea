//! Ids that nobody has had before, and the line by which a file of ours is known: a mark and an id.

use std::hash::{BuildHasher as _, Hasher as _, RandomState};

/// So many digits an id has.
const DIGITS: usize = 16;

/// Sixteen hexadecimal digits that nobody has had before.
#[must_use]
pub fn random_digits() -> String {
    // Each `RandomState` has new keys from the system.
    format!("{:0DIGITS$x}", RandomState::new().build_hasher().finish())
}

/// Whether a text can come from [`random_digits`].
pub(crate) fn is_id(text: &str) -> bool {
    text.len() == DIGITS && is_hexadecimal(text)
}

/// What a file says whose first line is to be a mark and an id.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Marked<'a> {
    /// The id, and what follows its line.
    Id(&'a str, &'a str),
    /// Nothing, or a line that was begun and never ended, by a kill on a full disk: nothing was made yet that is known by it.
    Begun,
    /// Something that is not ours.
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
