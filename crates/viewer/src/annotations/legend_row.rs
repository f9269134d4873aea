//! A row of a legend: a label, and a sample of how the labelled feature is drawn.

use image::RgbaImage;

use super::letters::{fill, of_255};
use corniche_styles::{LineStyle, PointStyle, Rgb, RoadBand};

/// Colours of lines that differ by at most this in each channel count as the same: on lines of a
/// few pixels the eye does not see the difference.
const ALIKE_ON_LINES: f32 = 0.09;
/// The same limit for edges of roads, which are a pixel or two wide.
const ALIKE_ON_EDGES: f32 = 0.15;
/// The same limit for areas, which are larger on the picture.
const ALIKE_ON_AREAS: f32 = 0.03;
/// Lines whose widths differ by less count as equally wide.
const ALIKE_PX: f32 = 1.0;
/// Length of a dash of a tunnel's edge and the gap after it together.
const TUNNEL_DASH_PX: u32 = 12;

/// A row of a legend.
#[derive(Debug, Clone, PartialEq)]
pub struct LegendRow {
    /// The label of the row.
    pub label: String,
    /// How the labelled feature is drawn.
    pub sample: LegendSample,
}

/// How a feature is drawn, with the colours that it has over the ground.
#[derive(Debug, Clone, PartialEq)]
pub enum LegendSample {
    /// A road.
    Road(LegendRoad),
    /// A road under the ground, whose edge is dashed.
    Tunnel(LegendRoad),
    /// A line that is not a road, such as a boundary.
    Line(LineStyle),
    /// A point.
    Point(PointStyle),
    /// An area.
    Area(Rgb),
}

/// How a road is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct LegendRoad {
    /// Width of the road in the picture, without its edge.
    pub width_px: f32,
    /// Colours of the surface, from its edges to its middle.
    pub bands: Vec<RoadBand>,
    /// The edge of the road, if it has one.
    pub edge: Option<LegendEdge>,
}

/// The edge of a road.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegendEdge {
    /// Colour of the edge.
    pub color: Rgb,
    /// Width of the edge.
    pub width_px: u32,
}

impl LegendRow {
    /// Merges rows that look alike into the first of them, with all their labels, so that all rows
    /// look different.
    #[must_use]
    pub fn joined(rows: Vec<Self>) -> Vec<Self> {
        let mut joined: Vec<Self> = Vec::new();
        for row in rows {
            match joined.iter_mut().find(|known| known.sample.looks_like(&row.sample)) {
                Some(known) if known.label == row.label => {}
                Some(known) => known.label = format!("{}, {}", known.label, row.label),
                None => joined.push(row),
            }
        }
        joined
    }
}

impl LegendSample {
    /// Whether nobody could distinguish the two samples in a picture.
    fn looks_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Road(one), Self::Road(other)) | (Self::Tunnel(one), Self::Tunnel(other)) => {
                one.looks_like(other)
            }
            (Self::Line(one), Self::Line(other)) => {
                let casings = match (one.casing, other.casing) {
                    (Some(one), Some(other)) => are_alike(one, other, ALIKE_ON_LINES),
                    (one, other) => one == other,
                };
                casings
                    && one.dash == other.dash
                    && (one.width_px - other.width_px).abs() < ALIKE_PX
                    && are_alike(one.color, other.color, ALIKE_ON_LINES)
            }
            (Self::Point(one), Self::Point(other)) => {
                one.outline.is_some() == other.outline.is_some()
                    && (one.size_px - other.size_px).abs() < ALIKE_PX
                    && are_alike(one.color, other.color, ALIKE_ON_LINES)
            }
            (Self::Area(one), Self::Area(other)) => are_alike(*one, *other, ALIKE_ON_AREAS),
            _ => false,
        }
    }

    /// Draws the sample into a cell of a legend, given by its upper left corner and its size.
    pub(crate) fn draw(&self, picture: &mut RgbaImage, corner: [u32; 2], size: [u32; 2]) {
        let [[left, top], [width, height]] = [corner, size];
        match self {
            Self::Road(road) => road.draw(picture, corner, size, None),
            Self::Tunnel(road) => road.draw(picture, corner, size, Some(TUNNEL_DASH_PX)),
            Self::Line(style) => draw_line(picture, style, corner, size),
            Self::Point(style) => draw_point(picture, style, corner, size),
            Self::Area(color) => {
                let rows = top + height / 8..top + height - height / 8;
                fill(picture, left..left + width, rows, of_255(*color), 1.0);
            }
        }
    }
}

impl LegendRoad {
    fn looks_like(&self, other: &Self) -> bool {
        let is_like = |one: &RoadBand, other: &RoadBand| {
            (one.width_share - other.width_share).abs() * self.width_px < ALIKE_PX
                && are_alike(one.color, other.color, ALIKE_ON_LINES)
        };
        let edges = match (self.edge, other.edge) {
            (Some(one), Some(other)) => {
                one.width_px == other.width_px && are_alike(one.color, other.color, ALIKE_ON_EDGES)
            }
            (one, other) => one == other,
        };
        edges
            && (self.width_px - other.width_px).abs() < ALIKE_PX
            && self.bands.len() == other.bands.len()
            && self.bands.iter().zip(&other.bands).all(|(one, other)| is_like(one, other))
    }

    /// Draws the road. `dash_px` is the length of a dash of its edge and the gap after it, which
    /// are equally long; `None`: the edge is solid.
    fn draw(
        &self,
        picture: &mut RgbaImage,
        [left, top]: [u32; 2],
        [width, height]: [u32; 2],
        dash_px: Option<u32>,
    ) {
        let edge_px = self.edge.map_or(0, |edge| edge.width_px);
        // With more bands a sample is thicker, so that each band is visible, as far as the line has
        // space.
        let least = (2 * self.bands.len() as u32).saturating_sub(1).max(1);
        let most = (height * 3 / 4).saturating_sub(2 * edge_px).max(1);
        let thick = (self.width_px.round() as u32).max(least).min(most);
        let start = top + (height - thick) / 2;
        let columns = left..left + width;
        if let Some(LegendEdge { color, .. }) = self.edge {
            for column in columns.clone() {
                if dash_px.is_none_or(|px| (column - left) % px < px / 2) {
                    let rows = start.saturating_sub(edge_px)..start + thick + edge_px;
                    fill(picture, column..column + 1, rows, of_255(color), 1.0);
                }
            }
        }
        for band in &self.bands {
            let beside = beside_px(thick, band.width_share);
            let rows = start + beside..start + thick - beside;
            fill(picture, columns.clone(), rows, of_255(band.color), 1.0);
        }
    }
}

/// Returns how many of the `thick` pixels across a road are on each side of a band with this share
/// of its width. The band has at least one or two pixels.
fn beside_px(thick: u32, width_share: f32) -> u32 {
    let exact = 0.5 * thick as f32 * (1.0 - width_share);
    (exact.round() as u32).min(thick.saturating_sub(1) / 2)
}

fn draw_line(
    picture: &mut RgbaImage,
    style: &LineStyle,
    [left, top]: [u32; 2],
    [width, height]: [u32; 2],
) {
    let thick = (style.width_px.round() as u32).clamp(1, height.saturating_sub(2).max(1));
    let start = top + (height - thick) / 2;
    for column in 0..width {
        let share = style.dash.width_at(column as f32 + 0.5);
        let beside = (0.5 * (1.0 - share) * thick as f32).round() as u32;
        if share > 0.0 && 2 * beside < thick {
            let rows = start + beside..start + thick - beside;
            let columns = left + column..left + column + 1;
            if let Some(casing) = style.casing {
                let rows = rows.start.saturating_sub(1)..rows.end + 1;
                fill(picture, columns.clone(), rows, of_255(casing), 1.0);
            }
            fill(picture, columns, rows, of_255(style.color), 1.0);
        }
    }
}

/// Draws a disc into the middle of a cell, as large as the cell allows.
fn draw_point(
    picture: &mut RgbaImage,
    style: &PointStyle,
    [left, top]: [u32; 2],
    [width, height]: [u32; 2],
) {
    let radius = (style.size_px / 2.0).min(height as f32 / 2.0 - 1.0);
    let edge_px = f32::from(u8::from(style.outline.is_some()));
    for row in 0..height {
        for column in 0..width {
            let from_middle = |at: u32, side: u32| at as f32 + 0.5 - side as f32 / 2.0;
            let from_middle = from_middle(column, width).hypot(from_middle(row, height));
            if from_middle > radius + edge_px {
                continue;
            }
            let color = style.outline.filter(|_| from_middle > radius).unwrap_or(style.color);
            let (x, y) = (left + column, top + row);
            fill(picture, x..x + 1, y..y + 1, of_255(color), 1.0);
        }
    }
}

fn are_alike(one: Rgb, other: Rgb, most: f32) -> bool {
    one.iter().zip(other).all(|(one, other)| (one - other).abs() <= most)
}

#[cfg(test)]
#[path = "legend_row_tests.rs"]
mod tests;
