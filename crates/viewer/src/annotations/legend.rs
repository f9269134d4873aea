//! Draws a legend into the lower left corner of a picture: rows of samples, heights, a scale bar
//! and a north arrow.

use image::RgbaImage;

use super::{
    legend_row::LegendRow,
    letters::{BOX, INK, Letters, blend, fill, line_px, of_255},
};
use corniche_styles::Rgb;

/// The contents of a legend.
#[derive(Debug, Clone, PartialEq)]
pub struct Legend {
    /// True metres of ground per pixel in the middle of the picture, from east to west along the
    /// parallel in the middle of the data.
    pub pixel_m: f64,
    /// The direction of north, clockwise from the picture's upward direction.
    pub north_deg: f64,
    /// The denominator of the scale of the printed picture, if it is known.
    pub scale: Option<u32>,
    /// The colour of the ground in the middle of the picture, behind the samples.
    pub ground: Rgb,
    /// The rows of what the picture shows, the most important first.
    pub rows: Vec<LegendRow>,
    /// The heights of the ground in the picture, if colours show heights.
    pub heights: Option<LegendHeights>,
}

/// The colours of the ground by its height.
#[derive(Debug, Clone, PartialEq)]
pub struct LegendHeights {
    /// The lowest and the highest ground in the picture, metres.
    pub range_m: [f64; 2],
    /// Colours from the lowest ground to the highest, at equal steps.
    pub colors: Vec<Rgb>,
}

/// Maximum length of the scale bar, as a share of the picture's width.
const BAR_SHARE: f64 = 0.12;

/// The horizontal layout of a row. All lengths are pixels.
struct Columns {
    line: u32,
    pad: u32,
    sample: u32,
}

impl Columns {
    fn from_image(picture: &RgbaImage) -> Self {
        let line = line_px(picture.height());
        Self { line, pad: line / 2, sample: 2 * line }
    }

    /// Where the text of a row begins.
    fn text(&self) -> u32 {
        2 * self.pad + self.sample
    }

    /// The length of the ramp of heights.
    fn ramp(&self) -> u32 {
        4 * self.line
    }
}

/// Space on the picture that is already taken near the legend, pixels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct OccupiedMargins {
    /// Height of the title, from the top.
    pub title_px: u32,
    /// Width and height of the attribution in the lower right corner.
    pub credits_px: [u32; 2],
}

/// Draws a legend into the lower left corner, on an opaque box: a sample and a name in each row,
/// the colours of heights, a north arrow, and a bar with its length on the ground in the middle of
/// the picture. If the legend does not fit next to the attribution, it is drawn above. Rows that do
/// not fit below the title are counted in a last row. Returns whether the picture is still too
/// small, so that a part of the legend is cut off.
pub fn draw_legend(picture: &mut RgbaImage, legend: &Legend, taken: OccupiedMargins) -> bool {
    let width = picture.width();
    let columns = Columns::from_image(picture);
    let Columns { line, pad, .. } = columns;
    let Some(letters) = Letters::new(line) else { return false };
    let bar_m = bar_length_m(f64::from(width) * BAR_SHARE * legend.pixel_m);
    let Some(bar_m) = bar_m else { return false };
    let bar_text = scale_text(bar_m, legend.scale);
    let bar_px = (bar_m / legend.pixel_m).round() as u32;

    let ends = legend.heights.as_ref().map(|heights| heights.range_m.map(height_text));
    let below = 1 + u32::from(ends.is_some());
    let labels: Vec<&String> = legend.rows.iter().map(|row| &row.label).collect();
    let label_px = columns.text() + letters.widest_px(&labels);
    let ramp_px = ends.as_ref().map(|[low, high]| {
        let texts_px = letters.widest_px(&[low]) + letters.widest_px(&[high]);
        3 * pad + columns.ramp() + texts_px
    });
    let bar_line_px = 2 * pad + bar_px + letters.widest_px(&[&bar_text]);
    let widest_px = bar_line_px.max(label_px).max(ramp_px.unwrap_or(0));
    let wanted_px = widest_px + pad + 2 * line;
    let right = wanted_px.min(width);
    let is_beside = right + taken.credits_px[0] <= width;
    let below_px = if is_beside { 0 } else { taken.credits_px[1] };
    let height = picture.height().saturating_sub(below_px);

    let room_px = height.saturating_sub(taken.title_px + pad);
    let room = (room_px / line).saturating_sub(below) as usize;
    let (rows, rest) = fitting(&legend.rows, room);
    let lines = rows.len() as u32 + u32::from(rest.is_some()) + below;
    let top = height.saturating_sub(lines.max(2) * line + pad);
    fill(picture, 0..right, top..height, BOX, 1.0);

    let above_row = |row: u32| top + pad / 2 + row * line;
    for (row, number) in rows.iter().zip(0_u32..) {
        let above = above_row(number);
        fill(picture, pad..pad + columns.sample, above..above + line, of_255(legend.ground), 1.0);
        row.sample.draw(picture, [pad, above], [columns.sample, line]);
        letters.draw(picture, &row.label, columns.text() as f32, above as f32);
    }
    if let Some(rest) = rest {
        letters.draw(picture, &rest, columns.text() as f32, above_row(rows.len() as u32) as f32);
    }
    if let (Some(heights), Some(ends)) = (&legend.heights, &ends) {
        let above = height.saturating_sub(2 * line + pad / 2);
        draw_ramp(picture, &letters, (&heights.colors, ends), above, &columns);
    }

    let above = height.saturating_sub(line + pad / 2);
    let (base, tick) = (above + line * 3 / 4, line / 3);
    fill(picture, pad..pad + bar_px, base - 2..base, INK, 1.0);
    for end in [pad, pad + bar_px - 2] {
        fill(picture, end..end + 2, base - tick..base, INK, 1.0);
    }
    letters.draw(picture, &bar_text, (2 * pad + bar_px) as f32, above as f32);

    let middle = [f64::from(right.saturating_sub(pad / 2 + line)), f64::from(top + line + pad / 2)];
    draw_arrow(picture, middle, f64::from(line) * 0.85, legend.north_deg);
    wanted_px > width || lines.max(2) * line > room_px
}

/// Returns the rows that fit, and, if some do not, a text for one more row with their number.
fn fitting(rows: &[LegendRow], room: usize) -> (&[LegendRow], Option<String>) {
    if rows.len() <= room {
        return (rows, None);
    }
    let shown = room.saturating_sub(1);
    (&rows[..shown], Some(format!("and {} more", rows.len() - shown)))
}

/// Draws the lowest height, the colours from it to the highest one, and the highest height.
fn draw_ramp(
    picture: &mut RgbaImage,
    letters: &Letters,
    (colors, [low, high]): (&[Rgb], &[String; 2]),
    above: u32,
    columns: &Columns,
) {
    let Columns { line, pad, .. } = *columns;
    let ramp = columns.ramp();
    letters.draw(picture, low, pad as f32, above as f32);
    let left = pad + letters.widest_px(&[low]) + pad / 2;
    for column in 0..ramp {
        let place = column as usize * colors.len() / ramp as usize;
        let Some(color) = colors.get(place) else { continue };
        let rows = above + line / 5..above + line - line / 5;
        fill(picture, left + column..left + column + 1, rows, of_255(*color), 1.0);
    }
    letters.draw(picture, high, (left + ramp + pad / 2) as f32, above as f32);
}

/// The text next to the scale bar.
fn scale_text(bar_m: f64, scale: Option<u32>) -> String {
    let length = bar_length(bar_m);
    scale.map_or(length.clone(), |scale| format!("{length}   1 : {}", grouped(u64::from(scale))))
}

/// Formats a height: "2 340 m".
fn height_text(height_m: f64) -> String {
    let metres = height_m.round();
    let sign = if metres < 0.0 { "−" } else { "" };
    format!("{sign}{} m", grouped(metres.abs() as u64))
}

/// Formats a whole number in groups of three: "1 234 567". The separators are no-break spaces; some
/// fonts lack the narrow one.
#[must_use]
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('\u{a0}');
        }
        text.push(digit);
    }
    text
}

/// Returns the longest length for a scale bar that is at most `most_m`: 1, 2 or 5 times a power of
/// ten, metres. `None` if `most_m` is not a positive number.
#[must_use]
pub fn bar_length_m(most_m: f64) -> Option<f64> {
    // This form also rejects NaN.
    if !(most_m > 0.0 && most_m.is_finite()) {
        return None;
    }
    let power = 10_f64.powf(most_m.log10().floor());
    let step = [5.0, 2.0, 1.0].into_iter().find(|step| step * power <= most_m).unwrap_or(1.0);
    Some(step * power)
}

/// Formats the length of a scale bar: "20 m", "5 km", "10 cm", "2 mm".
#[must_use]
pub fn bar_length(m: f64) -> String {
    if m >= 1000.0 {
        format!("{:.0} km", m / 1000.0)
    } else if m >= 1.0 {
        format!("{m:.0} m")
    } else if m >= 0.01 {
        format!("{:.0} cm", m * 100.0)
    } else {
        format!("{} mm", m * 1000.0)
    }
}

/// Draws a slim triangle that points north, with a light right half.
fn draw_arrow(picture: &mut RgbaImage, [x, y]: [f64; 2], radius: f64, north_deg: f64) {
    let (sine, cosine) = north_deg.to_radians().sin_cos();
    let reach = radius.ceil() as i64;
    for row in -reach..=reach {
        for column in -reach..=reach {
            // Rotated so that `along` grows to the north and `across` to the east.
            let (right, up) = (column as f64, -row as f64);
            let (along, across) = (right * sine + up * cosine, right * cosine - up * sine);
            let share = (along + radius) / (2.0 * radius);
            let half = 0.55 * radius * (1.0 - share);
            // The arrow has a notch at its base.
            let inside = (0.0..=1.0).contains(&share)
                && across.abs() <= half
                && along + radius >= 0.5 * (0.55 * radius - across.abs()).max(0.0);
            let (column, row) = (x as i64 + column, y as i64 + row);
            if let (true, Ok(column), Ok(row)) = (inside, column.try_into(), row.try_into()) {
                let is_edge = across.abs() > half - 1.5;
                let color = if across < 0.0 || is_edge { INK } else { [255.0; 3] };
                blend(picture, column, row, color, 1.0);
            }
        }
    }
}

#[cfg(test)]
#[path = "legend_tests.rs"]
mod tests;
