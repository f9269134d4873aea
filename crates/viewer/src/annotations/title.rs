//! Draws a title into the upper left corner of a picture.

use image::RgbaImage;

use super::letters::{BOX, Letters, fill, line_px};

/// Size of the letters of a title, relative to other letters.
const SIZE: u32 = 2;

/// The parts of a title that are not visible as they were written.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TitleFlaws {
    /// Characters that the font lacks; boxes are drawn instead of them.
    pub lacking: String,
    /// Whether the picture is too small for the title, so that a part is cut off.
    pub is_cut: bool,
}

/// A title that was drawn.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct WrittenTitle {
    /// Height of the box of the title.
    pub height_px: u32,
    /// The parts of the title that are not visible.
    pub flaws: TitleFlaws,
}

/// Draws a title into the upper left corner, on an opaque box. A title without letters changes
/// nothing.
///
/// A title that is too long for the picture is wrapped between words.
pub fn draw_title(picture: &mut RgbaImage, title: &str) -> WrittenTitle {
    let (width, height) = picture.dimensions();
    let line_px = SIZE * line_px(height);
    let pad_px = line_px / 4;
    let Some(letters) = Letters::new(line_px) else { return WrittenTitle::default() };
    let room_px = width.saturating_sub(2 * pad_px) as f32;
    let lines = letters.wrap(title, room_px);
    if lines.is_empty() {
        return WrittenTitle::default();
    }
    let widest_px = letters.widest_px(&lines);
    let right = widest_px + 2 * pad_px;
    let bottom = lines.len() as u32 * line_px + pad_px;
    fill(picture, 0..right.min(width), 0..bottom.min(height), BOX, 1.0);
    for (line, row) in lines.iter().zip(0_u32..) {
        letters.draw(picture, line, pad_px as f32, (pad_px / 2 + row * line_px) as f32);
    }
    let is_cut = right > width || bottom > height;
    let flaws = TitleFlaws { lacking: letters.lacking(title), is_cut };
    WrittenTitle { height_px: bottom.min(height), flaws }
}

#[cfg(test)]
#[path = "title_tests.rs"]
mod tests;
