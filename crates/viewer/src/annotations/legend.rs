//! A legend is drawn into the lower left corner of a picture: classes, scale bar and an arrow to the north.

use image::RgbaImage;

use super::letters::{INK, Letters, blend, draw_box, fill, line_px};
use corniche_styles::{LineStyle, Rgb, RoadBands};

/// What a legend tells.
#[derive(Debug, Clone, PartialEq)]
pub struct Legend {
    /// How much true ground a pixel covers in the middle of the picture, metres.
    pub pixel_m: f64,
    /// Where north is: clockwise from the picture's upward direction.
    pub north_deg: f64,
    /// The roads of the picture, most important first.
    pub roads: Vec<LegendRoad>,
    /// The areas of the picture, the topmost first.
    pub areas: Vec<LegendArea>,
    /// The boundaries of the picture, most important first.
    pub boundaries: Vec<LegendLine>,
}

/// A class of boundaries in a legend.
#[derive(Debug, Clone, PartialEq)]
pub struct LegendLine {
    /// What people call it.
    pub label: String,
    /// How it is drawn, with its colour as over the ground.
    pub style: LineStyle,
}

/// A class of areas in a legend.
#[derive(Debug, Clone, PartialEq)]
pub struct LegendArea {
    /// What people call it.
    pub label: String,
    /// Its colour on the ground.
    pub color: Rgb,
}

/// A class of roads in a legend.
#[derive(Debug, Clone, PartialEq)]
pub struct LegendRoad {
    /// What people call it.
    pub label: String,
    /// The colours of its surface.
    pub bands: RoadBands,
    /// The colour of its edge.
    pub outline: Rgb,
}

/// The scale bar is about this part of the picture's width.
const BAR_SHARE: f64 = 0.12;

/// Draws a legend into the lower left corner, on a light box: a sample of each class of roads, areas and boundaries, an arrow to the north, and a bar
/// with its length on the ground in the middle of the picture.
pub fn draw_legend(picture: &mut RgbaImage, legend: &Legend) {
    let (width, height) = picture.dimensions();
    let line_px = line_px(height);
    let pad_px = line_px / 2;
    let Some(letters) = Letters::new(line_px) else { return };
    let Some(bar_m) = bar_length_m(f64::from(width) * BAR_SHARE * legend.pixel_m) else { return };
    let bar_text = bar_length(bar_m);
    let bar_px = (bar_m / legend.pixel_m).round() as u32;
    let sample_px = 2 * line_px;
    let labels = legend.roads.iter().map(|road| road.label.as_str());
    let labels = labels.chain(legend.areas.iter().map(|area| area.label.as_str()));
    let labels = labels.chain(legend.boundaries.iter().map(|line| line.label.as_str()));
    let labels_px = letters.widest_px(labels);
    let bar_line_px = bar_px + pad_px + letters.widest_px([bar_text.as_str()].into_iter());
    let classes = (legend.roads.len() + legend.areas.len() + legend.boundaries.len()) as u32;
    let classes_px = if classes == 0 { 0 } else { sample_px + pad_px + labels_px };
    let right = bar_line_px.max(classes_px) + 2 * pad_px + 2 * line_px;
    let lines = classes + 1;
    let top = height.saturating_sub(lines.max(2) * line_px + pad_px);
    draw_box(picture, 0..right.min(width), top..height);

    let above_row = |row: u32| top + pad_px / 2 + row * line_px;
    let of_255 = |rgb: Rgb| rgb.map(|part| part * 255.0);
    for (road, row) in legend.roads.iter().zip(0_u32..) {
        let above = above_row(row);
        // With more bands a sample is thicker, so that each of them is seen, as far as a line has room.
        let bands = road.bands.all();
        let thick = (line_px / 3).max(2 * bands.len() as u32 + 1).min(line_px - 2);
        let start = above + (line_px - thick) / 2;
        let rows = start..start + thick;
        let columns = pad_px..pad_px + sample_px;
        fill(picture, columns.clone(), rows, of_255(road.outline), 1.0);
        for band in bands {
            let beside =
                (0.5 * f64::from(thick - 2) * f64::from(1.0 - band.width_share)) as u32 + 1;
            let rows = start + beside..start + thick - beside;
            fill(picture, columns.clone(), rows, of_255(band.color), 1.0);
        }
        letters.draw(picture, &road.label, (2 * pad_px + sample_px) as f32, above as f32);
    }

    for (area, row) in legend.areas.iter().zip(legend.roads.len() as u32..) {
        let above = above_row(row);
        let rows = above + line_px / 8..above + line_px - line_px / 8;
        fill(picture, pad_px..pad_px + sample_px, rows, of_255(area.color), 1.0);
        letters.draw(picture, &area.label, (2 * pad_px + sample_px) as f32, above as f32);
    }

    let first = (legend.roads.len() + legend.areas.len()) as u32;
    for (line, row) in legend.boundaries.iter().zip(first..) {
        let above = above_row(row);
        let thick = (line.style.width_px.round() as u32).clamp(1, line_px - 2);
        let start = above + (line_px - thick) / 2;
        for column in 0..sample_px {
            let share = line.style.dash.width_at(column as f32 + 0.5);
            let beside = (0.5 * (1.0 - share) * thick as f32).round() as u32;
            if share > 0.0 && 2 * beside < thick {
                let rows = start + beside..start + thick - beside;
                let columns = pad_px + column..pad_px + column + 1;
                fill(picture, columns, rows, of_255(line.style.color), 1.0);
            }
        }
        letters.draw(picture, &line.label, (2 * pad_px + sample_px) as f32, above as f32);
    }

    let above = height.saturating_sub(line_px + pad_px / 2);
    let (base, tick) = (above + line_px * 3 / 4, line_px / 3);
    fill(picture, pad_px..pad_px + bar_px, base - 2..base, INK, 1.0);
    for end in [pad_px, pad_px + bar_px - 2] {
        fill(picture, end..end + 2, base - tick..base, INK, 1.0);
    }
    letters.draw(picture, &bar_text, (2 * pad_px + bar_px) as f32, above as f32);

    let middle = [f64::from(right - pad_px / 2 - line_px), f64::from(top + line_px + pad_px / 2)];
    draw_arrow(picture, middle, f64::from(line_px) * 0.85, legend.north_deg);
}

/// The longest length for a scale bar that is not longer than `most_m`: 1, 2 or 5 times a power of ten, metres. `None` where
/// `most_m` is no positive number.
#[must_use]
pub fn bar_length_m(most_m: f64) -> Option<f64> {
    // This form also refuses NaN.
    if !(most_m > 0.0 && most_m.is_finite()) {
        return None;
    }
    let power = 10_f64.powf(most_m.log10().floor());
    let step = [5.0, 2.0, 1.0].into_iter().find(|step| step * power <= most_m).unwrap_or(1.0);
    Some(step * power)
}

/// Such a length in words: "20 m", "5 km", "10 cm".
#[must_use]
pub fn bar_length(m: f64) -> String {
    if m >= 1000.0 {
        format!("{:.0} km", m / 1000.0)
    } else if m >= 1.0 {
        format!("{m:.0} m")
    } else {
        format!("{:.0} cm", m * 100.0)
    }
}

/// A slim triangle that points to the north, its right half light.
fn draw_arrow(picture: &mut RgbaImage, [x, y]: [f64; 2], radius: f64, north_deg: f64) {
    let (sine, cosine) = north_deg.to_radians().sin_cos();
    let reach = radius.ceil() as i64;
    for row in -reach..=reach {
        for column in -reach..=reach {
            // Turned back: `along` grows to the north, `across` to the east.
            let (right, up) = (column as f64, -row as f64);
            let (along, across) = (right * sine + up * cosine, right * cosine - up * sine);
            let share = (along + radius) / (2.0 * radius);
            let half = 0.55 * radius * (1.0 - share);
            // Notched at its base.
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
