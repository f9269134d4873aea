//! Escapes foreign texts for display: terminals obey control characters, and bidirectional ones
//! hide text.

use std::{
    borrow::Cow,
    io::{self, Write},
};

use corniche_export::is_unseen;

/// The text with all active characters escaped, as in `\u{1b}`.
pub(crate) fn for_people(text: &str) -> Cow<'_, str> {
    replaced(text, is_unseen, |character| character.escape_unicode().to_string())
}

/// The largest number of characters of a foreign value in a message. JSON documents are not
/// shortened.
const MOST_SHOWN: usize = 2000;

/// A foreign value for use within a message: escaped with [`one_line`], and shortened.
pub(crate) fn in_line(value: &str) -> Cow<'_, str> {
    line_within(value, MOST_SHOWN)
}

/// A text as one line of at most `most` characters.
pub(crate) fn line_within(text: &str, most: usize) -> Cow<'_, str> {
    match shortened(text, most) {
        Cow::Borrowed(text) => one_line(text),
        Cow::Owned(text) => Cow::Owned(one_line(&text).into_owned()),
    }
}

/// A text as one line: line breaks are also escaped, so that no part of it can be mistaken for
/// another line.
pub(crate) fn one_line(text: &str) -> Cow<'_, str> {
    let breaks = |character| is_unseen(character) || matches!(character, '\n' | '\t');
    replaced(text, breaks, |character| character.escape_unicode().to_string())
}

/// A text of at most `most` characters; an ellipsis marks omitted text.
pub(crate) fn shortened(text: &str, most: usize) -> Cow<'_, str> {
    if text.len() <= most || text.chars().nth(most).is_none() {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.chars().take(most.saturating_sub(1)).chain(['…']).collect())
}

/// A JSON document with active characters escaped as in JSON: programs read the same texts.
///
/// Such characters occur only within strings, and all of them have four hexadecimal digits.
pub(crate) fn in_json(document: &str) -> Cow<'_, str> {
    replaced(document, is_unseen, |character| format!("\\u{:04x}", u32::from(character)))
}

/// Writes JSON whose strings are escaped as in [`in_json`].
pub(crate) struct JsonTexts;

impl serde_json::ser::Formatter for JsonTexts {
    fn write_string_fragment<W: Write + ?Sized>(
        &mut self,
        out: &mut W,
        text: &str,
    ) -> io::Result<()> {
        out.write_all(in_json(text).as_bytes())
    }
}

fn replaced(
    text: &str,
    is_written_out: impl Fn(char) -> bool,
    written: impl Fn(char) -> String,
) -> Cow<'_, str> {
    if !text.contains(&is_written_out) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if is_written_out(character) {
            out.push_str(&written(character));
        } else {
            out.push(character);
        }
    }
    Cow::Owned(out)
}

#[cfg(test)]
#[path = "escaped_tests.rs"]
mod tests;
