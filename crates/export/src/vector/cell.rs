//! Text of external origin in files that people and their programs read line by line: as a cell of
//! CSV, and within a line.

use std::{borrow::Cow, fmt::Write as _};

/// Whether a character is invisible and may have an effect. Line breaks and tabs that this crate
/// writes itself are not checked.
#[must_use]
pub fn is_unseen(character: char) -> bool {
    match character {
        '\n' | '\t' => false,
        // Marks, embeddings, overrides and isolates of the bidirectional algorithm, and two kinds
        // of line breaks.
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
            true
        }
        // C0, DEL and C1.
        other => other.is_control(),
    }
}

/// Returns a text on one line: invisible characters, line breaks and tabs are escaped as in JSON
/// (`\u001b`), so that a record is always one line.
#[must_use]
pub fn text_in_line(text: &str) -> Cow<'_, str> {
    let is_written_out = |character: char| is_unseen(character) || matches!(character, '\n' | '\t');
    if !text.contains(is_written_out) {
        return Cow::Borrowed(text);
    }
    let mut line = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if is_written_out(character) {
            // Writing to a text cannot fail. All of these have four digits.
            let _ = write!(line, "\\u{:04x}", u32::from(character));
        } else {
            line.push(character);
        }
    }
    Cow::Owned(line)
}

/// Returns the text in a form that spreadsheets show rather than execute: on one line, and with a
/// leading `'` if it begins with `=`, `+`, `-` or `@` and is not a number.
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
