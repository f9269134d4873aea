//! Texts of other people as they may be shown: a terminal obeys control characters, and bidirectional ones hide what is written.

use std::{borrow::Cow, fmt::Write as _};

/// Whether a character does something other than to be seen. Line breaks and tabs are our own.
fn is_unseen(character: char) -> bool {
    match character {
        '\n' | '\t' => false,
        // Marks, embeddings, overrides and isolates of the bidirectional algorithm, and two kinds of line breaks.
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
            true
        }
        // C0, DEL and C1.
        other => other.is_control(),
    }
}

/// The text with what does something written out, as in `\u{1b}`.
pub(crate) fn for_people(text: &str) -> Cow<'_, str> {
    replaced(text, |out, character| {
        let _ = write!(out, "{}", character.escape_unicode());
    })
}

/// A JSON document in which what does something is written as JSON writes it: programs read the same texts.
///
/// Such characters can only stand within texts, and all of them have four digits.
pub(crate) fn in_json(document: &str) -> Cow<'_, str> {
    replaced(document, |out, character| {
        let _ = write!(out, "\\u{:04x}", u32::from(character));
    })
}

fn replaced(text: &str, write: impl Fn(&mut String, char)) -> Cow<'_, str> {
    if !text.contains(is_unseen) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if is_unseen(character) { write(&mut out, character) } else { out.push(character) }
    }
    Cow::Owned(out)
}

#[cfg(test)]
#[path = "escaped_tests.rs"]
mod tests;
