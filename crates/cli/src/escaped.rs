//! Texts of other people as they may be shown: a terminal obeys control characters, and bidirectional ones hide what is written.

use std::{
    borrow::Cow,
    fmt::Write as _,
    io::{self, Write},
};

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
    replaced(text, is_unseen, |out, character| {
        let _ = write!(out, "{}", character.escape_unicode());
    })
}

/// A value of others that stands within a line of ours: line breaks are written out, too, so that it cannot pass for another line.
pub(crate) fn in_line(value: &str) -> Cow<'_, str> {
    let breaks = |character| is_unseen(character) || matches!(character, '\n' | '\t');
    replaced(value, breaks, |out, character| {
        let _ = write!(out, "{}", character.escape_unicode());
    })
}

/// A JSON document in which what does something is written as JSON writes it: programs read the same texts.
///
/// Such characters can only stand within texts, and all of them have four digits.
pub(crate) fn in_json(document: &str) -> Cow<'_, str> {
    replaced(document, is_unseen, |out, character| {
        let _ = write!(out, "\\u{:04x}", u32::from(character));
    })
}

/// Writes JSON whose texts are as those of [`in_json`].
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
    write: impl Fn(&mut String, char),
) -> Cow<'_, str> {
    if !text.contains(&is_written_out) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if is_written_out(character) { write(&mut out, character) } else { out.push(character) }
    }
    Cow::Owned(out)
}

#[cfg(test)]
#[path = "escaped_tests.rs"]
mod tests;
