//! The type of colours in styles.

/// A colour as red, green, blue in sRGB, 0 to 1.
pub type Rgb = [f32; 3];
