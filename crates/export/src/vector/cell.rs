//! A text as a cell of CSV: spreadsheets take what begins with a sign for a formula, and run it.

use std::borrow::Cow;

/// The text as spreadsheets show it and do not run it: with `'` before it where it begins with `=`, `+`, `-`, `@`, a tab or a carriage return and is no
/// number.
///
/// Source: OWASP, *CSV Injection*.
#[must_use]
pub fn cell_text(text: &str) -> Cow<'_, str> {
    let is_number = || text.parse::<f64>().is_ok_and(f64::is_finite);
    if text.starts_with(['=', '+', '-', '@', '\t', '\r']) && !is_number() {
        Cow::Owned(format!("'{text}"))
    } else {
        Cow::Borrowed(text)
    }
}

#[cfg(test)]
#[path = "cell_tests.rs"]
mod tests;
