//! A key or value of a tag as text, cut at OSM's limit.

use std::borrow::Cow;

/// The maximum number of characters that OSM allows (OSM wiki, *API v0.6*: 255), each of at most
/// four bytes.
const MAX_TEXT_CHARS: usize = 255;

/// A tag's key or value.
#[derive(Clone)]
pub(crate) struct Text<'a> {
    pub(crate) text: Cow<'a, str>,
    pub(crate) is_cut: bool,
}

impl<'a> Text<'a> {
    /// Reads only the beginning, however long the text is, because a million ways may share it.
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        const MAX_BYTES: usize = 4 * MAX_TEXT_CHARS;
        let start = &bytes[..bytes.len().min(MAX_BYTES)];
        let text = match str::from_utf8(start) {
            // The cut may be within a character.
            Err(error) if error.error_len().is_none() && start.len() < bytes.len() => {
                String::from_utf8_lossy(&start[..error.valid_up_to()])
            }
            _ => String::from_utf8_lossy(start),
        };
        // A text has no more characters than bytes.
        let is_long = text.len() > MAX_TEXT_CHARS;
        let end = if is_long { text.char_indices().nth(MAX_TEXT_CHARS) } else { None };
        let end = end.map(|(at, _)| at);
        let is_cut = end.is_some() || start.len() < bytes.len();
        let text = match (end, text) {
            (Some(end), Cow::Borrowed(text)) => Cow::Borrowed(&text[..end]),
            (Some(end), Cow::Owned(mut text)) => {
                text.truncate(end);
                Cow::Owned(text)
            }
            (None, text) => text,
        };
        Self { text, is_cut }
    }
}
