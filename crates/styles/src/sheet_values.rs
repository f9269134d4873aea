//! Colours and numbers in a style's text.

use std::ops::RangeInclusive;

use serde::Deserialize;

use crate::{Rgb, StyleError, parse_color, to_bytes};

/// A colour as red, green, blue in sRGB.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct Rgb8(pub(crate) [u8; 3]);

impl TryFrom<String> for Rgb8 {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        parse_color(&text).map(|color| Self(to_bytes(color))).map_err(|error| error.to_string())
    }
}

impl From<Rgb8> for Rgb {
    fn from(Rgb8(channels): Rgb8) -> Self {
        channels.map(|channel| f32::from(channel) / 255.0)
    }
}

/// Rejects a number outside its range.
pub(crate) fn within(
    entry: &str,
    value: f64,
    range: RangeInclusive<f64>,
) -> Result<(), StyleError> {
    // NaN is not in any range.
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

/// Checks an optional number.
pub(crate) fn number(
    entry: &str,
    value: Option<f64>,
    range: RangeInclusive<f64>,
) -> Result<Option<f32>, StyleError> {
    value.map(|value| within(entry, value, range).map(|()| value as f32)).transpose()
}
