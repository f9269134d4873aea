//! How lines beside the roads are drawn: boundaries, and lines of people's own files.

use corniche_roads::FunctionalRoadClass;

use crate::{Rgb, RoadBand, RoadBands, RoadStyle, Style, StyleError};

/// How lines of one kind are drawn: everywhere equally wide on the picture, over the roads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineStyle {
    /// Its colour.
    pub color: Rgb,
    /// Width on the picture.
    pub width_px: f32,
    /// Colour of an edge of one pixel on both sides, outside of the width; `None`: without.
    pub casing: Option<Rgb>,
    /// How much of the map a line hides; 0 does not draw it.
    pub opacity: f32,
    /// Dashes along it.
    pub dash: Dash,
    /// The most true metres of ground in a pixel at which it is drawn in full, as [`RoadStyle::max_pixel_m`].
    pub max_pixel_m: Option<f32>,
}

/// A pattern of dashes and gaps that repeats along a line.
///
/// ```text
///   ├────────── one pattern ─────────┤
///   ██████████████      ████          ██████████████      ████
///     dash         gap  dash    gap
/// ```
///
/// Dashes lie on the ground: their lengths are true lengths along it, uphill too. From farther away they get longer, by a factor of
/// two each time, so that on the picture a pattern has at least the length asked for, and less than twice that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dash {
    /// Where the first dash, the first gap and the second dash end, as shares of the pattern.
    ends: [f32; 3],
    /// Least length of the pattern on the picture; 0 for a solid line.
    least_px: f32,
}

impl Dash {
    /// No gaps.
    pub const SOLID: Self = Self { ends: [1.0; 3], least_px: 0.0 };

    /// The longest dash or gap, pixels.
    pub const LONGEST_PX: f32 = 200.0;

    /// Dash, gap, and, if wanted, another dash and gap, in pixels of the picture; without any, a solid line.
    ///
    /// # Errors
    /// When there are one, three or more than four lengths, or one is not between 1 and [`Dash::LONGEST_PX`].
    pub fn new(lengths_px: &[f32]) -> Result<Self, StyleError> {
        let pattern = match *lengths_px {
            [] => return Ok(Self::SOLID),
            // The same dash and gap twice.
            [dash, gap] => [dash, gap, dash, gap],
            [dash, gap, second, last] => [dash, gap, second, last],
            _ => return Err(StyleError::DashCount { count: lengths_px.len() }),
        };
        if let Some(value) = pattern.iter().find(|px| !(1.0..=Self::LONGEST_PX).contains(*px)) {
            return Err(StyleError::DashLength { value: *value, most: Self::LONGEST_PX });
        }
        let sum: f32 = pattern.iter().sum();
        let mut reached = 0.0;
        let ends = [pattern[0], pattern[1], pattern[2]].map(|part| {
            reached += part / sum;
            reached
        });
        Ok(Self { ends, least_px: sum })
    }

    /// Where the first dash, the first gap and the second dash end, as shares of the pattern.
    #[must_use]
    pub const fn ends(&self) -> [f32; 3] {
        self.ends
    }

    /// Least length of the pattern on the picture; 0 for a solid line.
    #[must_use]
    pub const fn least_px(&self) -> f32 {
        self.least_px
    }
}

impl LineStyle {
    /// How many styles the lines of one layer can have.
    pub const MOST: usize = FunctionalRoadClass::COUNT;

    /// A solid line of this colour and width, drawn everywhere.
    #[must_use]
    pub const fn solid(color: Rgb, width_px: f32) -> Self {
        let (opacity, dash) = (1.0, Dash::SOLID);
        Self { color, width_px, casing: None, opacity, dash, max_pixel_m: None }
    }

    /// Whether such lines are drawn at all.
    #[must_use]
    pub fn is_drawn(&self) -> bool {
        self.opacity > 0.0
    }

    /// The same look as that of a road.
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
            // Far less than a pixel: the least width is what is drawn.
            width_m: 1e-3,
            min_width_px: width_px,
            bands,
            outline: self.color,
            max_pixel_m: self.max_pixel_m,
            max_width_px: None,
            thin: None,
            opacity: self.opacity,
            dash: self.dash,
        }
    }
}

impl Style {
    /// This style for a picture whose roads are lines in these styles: what has the place of class 0 is drawn in the first one. Places
    /// without a style are not drawn.
    #[must_use]
    pub fn with_lines_as_roads(&self, lines: &[LineStyle]) -> Self {
        let mut roads = self.roads.map(|road| RoadStyle { opacity: 0.0, ..road });
        for (road, line) in roads.iter_mut().zip(lines) {
            *road = line.as_road();
        }
        Self { roads, own_widths: None, outline_px: 0, shortest_part_px: 0.0, ..self.clone() }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "line_style_tests.rs"]
mod tests;
