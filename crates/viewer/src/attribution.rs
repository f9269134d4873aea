use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use image::RgbaImage;

/// Smallest and largest height of a line of text, pixels.
const LINE_PX: std::ops::RangeInclusive<u32> = 14..=28;
/// How many lines of text would fill the picture's height; their height stays within [`LINE_PX`].
const LINES_PER_PICTURE: u32 = 52;
/// Colour and opacity of the box behind the letters.
const BOX: ([f32; 3], f32) = ([255.0, 255.0, 255.0], 0.78);
const INK: [f32; 3] = [32.0, 36.0, 40.0];

/// Writes credits into the lower right corner, on a light box. Without credits the picture stays as it is.
///
/// Lines that are too long for the picture are broken between words.
pub fn draw_attribution(picture: &mut RgbaImage, credits: &[String]) {
    let (width, height) = picture.dimensions();
    let line_px = (height / LINES_PER_PICTURE).clamp(*LINE_PX.start(), *LINE_PX.end());
    let pad_px = line_px / 2;
    // The font is part of the program, so it can be parsed; otherwise nothing could be written.
    let Ok(font) = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT) else { return };
    let letters = Letters { font: &font, scale: PxScale::from(line_px as f32) };
    let room_px = width.saturating_sub(2 * pad_px) as f32;
    let lines: Vec<String> =
        credits.iter().flat_map(|credit| letters.wrap(credit, room_px)).collect();
    if lines.is_empty() {
        return;
    }
    let widest_px =
        lines.iter().fold(0.0, |widest: f32, line| widest.max(letters.width_px(line))).ceil()
            as u32;
    let left = width.saturating_sub(widest_px + 2 * pad_px);
    let top = height.saturating_sub(lines.len() as u32 * line_px + pad_px);
    for y in top..height {
        for x in left..width {
            blend(picture, x, y, BOX.0, BOX.1);
        }
    }
    for (line, row) in lines.iter().zip(0_u32..) {
        let x_px = width as f32 - pad_px as f32 - letters.width_px(line);
        let y_px = (top + pad_px / 2 + row * line_px) as f32;
        letters.draw(picture, line, x_px, y_px);
    }
}

struct Letters<'a> {
    font: &'a FontRef<'a>,
    scale: PxScale,
}

impl Letters<'_> {
    fn width_px(&self, text: &str) -> f32 {
        let scaled = self.font.as_scaled(self.scale);
        text.chars().map(|letter| scaled.h_advance(scaled.glyph_id(letter))).sum()
    }

    /// Breaks `text` between words so that each line fits into `room_px` if its words do.
    fn wrap(&self, text: &str, room_px: f32) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        for word in text.split_whitespace() {
            match lines.last_mut() {
                Some(line)
                    if self.width_px(line) + self.width_px(" ") + self.width_px(word)
                        <= room_px =>
                {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(word.to_owned()),
            }
        }
        lines
    }

    fn draw(&self, picture: &mut RgbaImage, text: &str, left_px: f32, top_px: f32) {
        let scaled = self.font.as_scaled(self.scale);
        let mut x_px = left_px;
        for letter in text.chars() {
            let id = scaled.glyph_id(letter);
            let glyph =
                id.with_scale_and_position(self.scale, point(x_px, top_px + scaled.ascent()));
            x_px += scaled.h_advance(id);
            let Some(outline) = self.font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|dx, dy, coverage| {
                let (x, y) = (corner.x + dx as f32, corner.y + dy as f32);
                if x >= 0.0 && y >= 0.0 {
                    blend(picture, x as u32, y as u32, INK, coverage);
                }
            });
        }
    }
}

fn blend(picture: &mut RgbaImage, x: u32, y: u32, color: [f32; 3], opacity: f32) {
    let Some(pixel) = picture.get_pixel_mut_checked(x, y) else { return };
    for (channel, wanted) in pixel.0.iter_mut().zip(color) {
        let here = f32::from(*channel);
        *channel = (here + (wanted - here) * opacity.clamp(0.0, 1.0)).round() as u8;
    }
}

#[cfg(test)]
#[path = "attribution_tests.rs"]
mod tests;
