//! Colours in styles, and how they are written.

/// A colour as red, green, blue in sRGB, 0 to 1.
pub type Rgb = [f32; 3];

/// Converts a colour to whole numbers, 0 to 255.
#[must_use]
pub fn to_bytes(color: Rgb) -> [u8; 3] {
    color.map(|channel| (channel * 255.0).round().clamp(0.0, 255.0) as u8)
}

/// Why a text is not a valid colour.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ColorError {
    /// The text is not a CSS colour.
    #[error("{text:?} is not a colour; write it like #D93A2B, or use a CSS name such as tomato")]
    Unknown {
        /// The text, or its first characters.
        text: String,
    },
    /// The colour is transparent.
    #[error("{text:?} is transparent; write an opaque colour and set the opacity separately")]
    SeenThrough {
        /// The text.
        text: String,
    },
}

/// Parses a colour such as "#D93A2B", in any notation of CSS, including names. The opacity of lines
/// and areas is a separate entry, so transparent colours are rejected.
///
/// # Errors
/// When the text is not a CSS colour, or the colour is transparent.
pub fn parse_color(text: &str) -> Result<Rgb, ColorError> {
    let own = || text.chars().take(64).collect();
    // CSS accepts both spellings of every grey.
    let color = ::color::parse_color(&text.to_ascii_lowercase().replace("grey", "gray"))
        .map_err(|_| ColorError::Unknown { text: own() })?;
    let color = color.to_alpha_color::<::color::Srgb>().to_rgba8();
    if color.a < 255 {
        return Err(ColorError::SeenThrough { text: own() });
    }
    Ok([color.r, color.g, color.b].map(|channel| f32::from(channel) / 255.0))
}

#[cfg(test)]
#[path = "color_tests.rs"]
mod tests;
