//! Text, boxes and lines on a picture in memory.

use std::ops::{Range, RangeInclusive};

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use corniche_styles::Rgb;
use image::RgbaImage;

/// Minimum and maximum height of a line of text, pixels.
const LINE_PX: RangeInclusive<u32> = 14..=28;
/// How many lines of text fill the picture's height; the height of a line stays within [`LINE_PX`].
const LINES_PER_PICTURE: u32 = 52;
/// Colour and opacity of the box behind the letters.
pub(crate) const BOX: [f32; 3] = [255.0; 3];
/// Opacity of a translucent box.
pub(crate) const BOX_OPACITY: f32 = 0.78;
/// Colour of letters.
pub(crate) const INK: [f32; 3] = [32.0, 36.0, 40.0];

/// Height of a line of text on a picture of this height, pixels.
pub(crate) fn line_px(picture_height: u32) -> u32 {
    (picture_height / LINES_PER_PICTURE).clamp(*LINE_PX.start(), *LINE_PX.end())
}

/// Letters of one size.
pub(crate) struct Letters {
    font: FontRef<'static>,
    scale: PxScale,
}

impl Letters {
    /// Letters for lines of this height.
    pub(crate) fn new(line_px: u32) -> Option<Self> {
        // The font is embedded in the program, so it can be parsed; otherwise nothing could be
        // written.
        let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).ok()?;
        Some(Self { font, scale: PxScale::from(line_px as f32) })
    }

    /// Returns the characters of a text that the font lacks, each once. Boxes are drawn instead of
    /// them.
    pub(crate) fn lacking(&self, text: &str) -> String {
        let mut lacking = String::new();
        let letters = text.chars().filter(|letter| !letter.is_whitespace());
        for letter in letters.filter(|letter| self.font.glyph_id(*letter).0 == 0) {
            if !lacking.contains(letter) {
                lacking.push(letter);
            }
        }
        lacking
    }

    pub(crate) fn width_px(&self, text: &str) -> f32 {
        let scaled = self.font.as_scaled(self.scale);
        text.chars().map(|letter| scaled.h_advance(scaled.glyph_id(letter))).sum()
    }

    /// Width of the widest line.
    pub(crate) fn widest_px(&self, lines: &[impl AsRef<str>]) -> u32 {
        lines.iter().map(|line| self.width_px(line.as_ref())).fold(0.0, f32::max).ceil() as u32
    }

    /// Wraps `text` between words so that each line fits into `room_px`, if its words do.
    pub(crate) fn wrap(&self, text: &str, room_px: f32) -> Vec<String> {
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

    pub(crate) fn draw(&self, picture: &mut RgbaImage, text: &str, left_px: f32, top_px: f32) {
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

/// Fills a rectangle with one colour, 0 to 255.
pub(crate) fn fill(
    picture: &mut RgbaImage,
    columns: Range<u32>,
    rows: Range<u32>,
    color: [f32; 3],
    opacity: f32,
) {
    for y in rows {
        for x in columns.clone() {
            blend(picture, x, y, color, opacity);
        }
    }
}

/// Converts a colour from 0 to 1 to 0 to 255.
pub(crate) fn of_255(color: Rgb) -> [f32; 3] {
    color.map(|part| part * 255.0)
}

/// Blends a colour into a pixel; does nothing outside the picture.
pub(crate) fn blend(picture: &mut RgbaImage, x: u32, y: u32, color: [f32; 3], opacity: f32) {
    let Some(pixel) = picture.get_pixel_mut_checked(x, y) else { return };
    for (channel, wanted) in pixel.0.iter_mut().zip(color) {
        let here = f32::from(*channel);
        *channel = (here + (wanted - here) * opacity.clamp(0.0, 1.0)).round() as u8;
    }
}
