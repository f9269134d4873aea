//! Draws the attribution into the lower right corner of a picture.

use image::RgbaImage;

use super::letters::{BOX, BOX_OPACITY, Letters, fill, line_px};

/// Draws the attribution into the lower right corner, on a light box. Without any text the picture
/// stays unchanged.
///
/// Lines that are too long for the picture are wrapped between words. Returns width and height of
/// the box.
pub fn draw_attribution(picture: &mut RgbaImage, credits: &[String]) -> [u32; 2] {
    let (width, height) = picture.dimensions();
    let line_px = line_px(height);
    let pad_px = line_px / 2;
    let Some(letters) = Letters::new(line_px) else { return [0; 2] };
    let room_px = width.saturating_sub(2 * pad_px) as f32;
    let lines: Vec<String> =
        credits.iter().flat_map(|credit| letters.wrap(credit, room_px)).collect();
    if lines.is_empty() {
        return [0; 2];
    }
    let widest_px = letters.widest_px(&lines);
    let left = width.saturating_sub(widest_px + 2 * pad_px);
    let top = height.saturating_sub(lines.len() as u32 * line_px + pad_px);
    fill(picture, left..width, top..height, BOX, BOX_OPACITY);
    for (line, row) in lines.iter().zip(0_u32..) {
        let x_px = width as f32 - pad_px as f32 - letters.width_px(line);
        let y_px = (top + pad_px / 2 + row * line_px) as f32;
        letters.draw(picture, line, x_px, y_px);
    }
    [width - left, height - top]
}

#[cfg(test)]
#[path = "credits_tests.rs"]
mod tests;
