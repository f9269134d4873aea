//! Lines in the slots of roads: the viewer draws them with the code for roads. User-drawn areas.

use crate::{AreaStyle, LineStyle, RoadBand, RoadBands, RoadStyle, Style};

impl LineStyle {
    /// Returns a road style with the same look.
    fn as_road(&self) -> RoadStyle {
        let inner = RoadBands::one(self.color);
        let (bands, width_px) = match self.casing {
            None => (inner, self.width_px),
            Some(casing) => {
                let width_px = self.width_px + 2.0;
                let width_share = self.width_px / width_px;
                let band = RoadBand { width_share, color: self.color };
                (RoadBands::one(casing).with_center(band), width_px)
            }
        };
        RoadStyle {
            // Far less than a pixel, so that the minimum width in pixels applies.
            width_m: 1e-3,
            carriageway_width_m: 1e-3,
            min_width_px: width_px,
            bands,
            outline: self.color,
            max_pixel_m: self.max_pixel_m,
            max_width_px: None,
            exponent: None,
            edge_max_pixel_m: None,
            thin: None,
            opacity: self.opacity,
            dash: self.dash,
        }
    }
}

impl Style {
    /// Returns this style for a picture that draws lines instead of roads: the lines of class 0
    /// have the first of these line styles, and so on. Classes without a line style are not drawn.
    #[must_use]
    pub fn with_lines_as_roads(&self, lines: &[LineStyle]) -> Self {
        let mut roads = self.roads.map(|road| RoadStyle { opacity: 0.0, ..road });
        for (road, line) in roads.iter_mut().zip(lines) {
            *road = line.as_road();
        }
        Self { roads, own_widths: None, outline_px: 0, shortest_part_px: 0.0, ..self.clone() }
    }
}

impl Style {
    /// How much of the map user-drawn areas hide.
    const DRAWN_AREAS_OPACITY: f32 = 0.3;

    /// How areas that a user draws look: they are filled with the colour of their outlines, and the
    /// map shows through.
    #[must_use]
    pub fn drawn_area(&self) -> AreaStyle {
        let opacity = Self::DRAWN_AREAS_OPACITY * self.drawn.opacity;
        AreaStyle { color: self.drawn.color, opacity, steepest_deg: None }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "lines_as_roads_tests.rs"]
mod tests;
