//! The type of colours in styles, and their text.

/// A colour as red, green, blue in sRGB, 0 to 1.
pub type Rgb = [f32; 3];

/// The same as whole numbers, 0 to 255.
#[must_use]
pub fn to_bytes(color: Rgb) -> [u8; 3] {
    color.map(|channel| (channel * 255.0).round().clamp(0.0, 255.0) as u8)
}

/// A text that is no colour.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ColorError {
    /// No colour of CSS.
    #[error("{text:?} is no colour; write it like #D93A2B, or by its name in CSS, such as tomato")]
    Unknown {
        /// The text, or its beginning.
        text: String,
    },
    /// A colour that can be seen through.
    #[error("{text:?} can be seen through; give a colour without that, and the opacity beside it")]
    SeenThrough {
        /// The text.
        text: String,
    },
}

/// A colour from its text: "#D93A2B", or as CSS has it otherwise, such as by its name. Lines and areas have their opacity beside it, so none is taken
/// here.
///
/// # Errors
/// When it is no colour of CSS, or one that can be seen through.
pub fn parse_color(text: &str) -> Result<Rgb, ColorError> {
    let own = || text.chars().take(64).collect();
    // CSS has both spellings of each grey.
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
