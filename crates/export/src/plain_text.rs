//! Texts of packages for libraries and formats that take plain text alone.

use std::borrow::Cow;

/// A text about a whole file: C's texts end at a NUL, and XML, which some formats keep such texts as, has no control characters.
pub(crate) fn plain_text(text: &str) -> Cow<'_, str> {
    if text.contains(char::is_control) {
        return Cow::Owned(text.replace(char::is_control, " "));
    }
    Cow::Borrowed(text)
}

/// A value of a feature. What cannot be in a text of C is replaced as what is no UTF-8 is.
pub(crate) fn without_nul(text: &str) -> Cow<'_, str> {
    if text.contains('\0') {
        return Cow::Owned(text.replace('\0', "\u{fffd}"));
    }
    Cow::Borrowed(text)
}

#[cfg(test)]
#[path = "plain_text_tests.rs"]
mod tests;
