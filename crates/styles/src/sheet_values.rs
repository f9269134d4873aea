//! Colours and numbers of a style's text.

use std::ops::RangeInclusive;

use serde::Deserialize;

use crate::{Rgb, StyleError};

/// A colour as red, green, blue in sRGB.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct Rgb8(pub(crate) [u8; 3]);

impl TryFrom<String> for Rgb8 {
    type Error = String;

    /// Reads "#RRGGBB".
    fn try_from(text: String) -> Result<Self, String> {
        let digits = text
            .strip_prefix('#')
            // `from_str_radix` would accept a sign too.
            .filter(|digits| digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit()))
            .and_then(|digits| u32::from_str_radix(digits, 16).ok());
        let [_, red, green, blue] = digits
            .ok_or_else(|| format!("{text:?} is no colour; write it like \"#D93A2B\""))?
            .to_be_bytes();
        Ok(Self([red, green, blue]))
    }
}

impl From<Rgb8> for Rgb {
    fn from(Rgb8(channels): Rgb8) -> Self {
        channels.map(|channel| f32::from(channel) / 255.0)
    }
}

/// Refuses a number outside its range.
pub(crate) fn within(
    entry: &str,
    value: f64,
    range: RangeInclusive<f64>,
) -> Result<(), StyleError> {
    // NaN is in no range.
    if range.contains(&value) {
        return Ok(());
    }
    Err(StyleError::Range {
        entry: entry.to_owned(),
        value,
        least: *range.start(),
        most: *range.end(),
    })
}
