//! Texts of others in files that people and their programs read line by line: as a cell of CSV, and within a line.

use std::{borrow::Cow, fmt::Write as _};

/// Whether a character does something other than to be seen. Line breaks and tabs, which we write ourselves, are not asked about.
#[must_use]
pub fn is_unseen(character: char) -> bool {
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

/// A text within a line: what is not seen, line breaks and tabs are written as JSON writes them (`\u001b`), so that a record is always one line.
#[must_use]
pub fn text_in_line(text: &str) -> Cow<'_, str> {
    let is_written_out = |character: char| is_unseen(character) || matches!(character, '\n' | '\t');
    if !text.contains(is_written_out) {
        return Cow::Borrowed(text);
    }
    let mut line = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if is_written_out(character) {
            // Writing to a text cannot fail. All of them have four digits.
            let _ = write!(line, "\\u{:04x}", u32::from(character));
        } else {
            line.push(character);
        }
    }
    Cow::Owned(line)
}

/// The text as spreadsheets show it and do not run it: within a line, and with `'` before it where it begins with `=`, `+`, `-` or `@` and is no number.
///
/// Source: OWASP, *CSV Injection*.
#[must_use]
pub fn cell_text(text: &str) -> Cow<'_, str> {
    let is_number = || text.parse::<f64>().is_ok_and(f64::is_finite);
    if text.starts_with(['=', '+', '-', '@']) && !is_number() {
        Cow::Owned(format!("'{}", text_in_line(text)))
    } else {
        text_in_line(text)
    }
}

#[cfg(test)]
#[path = "cell_tests.rs"]
mod tests;
