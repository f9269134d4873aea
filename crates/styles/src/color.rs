//! The type of colours in styles.

/// A colour as red, green, blue in sRGB, 0 to 1.
pub type Rgb = [f32; 3];

/// The same as whole numbers, 0 to 255.
#[must_use]
pub fn to_bytes(color: Rgb) -> [u8; 3] {
    color.map(|channel| (channel * 255.0).round().clamp(0.0, 255.0) as u8)
}
