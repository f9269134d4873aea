//! The stripes of a road, such as casing, fill and centre line, drawn on top of each other.

use crate::{Rgb, StyleError};
use serde::{Deserialize, Serialize};

/// Stripes along a road, drawn on top of each other, each narrower than the one below: from the
/// road's whole width to its middle.
///
/// ```text
///   ├────────── 1.0 ──────────┤   the first band is the road
///   │████░░░░░░░▓▓▓░░░░░░░████│
///        ├───── 0.7 ─────┤        each further one covers the middle of the one before it
///             ├ 0.2 ┤
/// ```
///
/// There is at least one band and at most [`RoadBands::MOST`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RoadBands {
    bands: [RoadBand; Self::MOST],
    count: usize,
}

/// One of the [`RoadBands`] of a road.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RoadBand {
    /// Width of the band as a share of the road's width.
    pub width_share: f32,
    /// Colour of the band.
    pub color: Rgb,
}

impl RoadBands {
    /// The maximum number of bands of a road. The viewer stores class and band of each sample of a
    /// picture in 8 bits, the format that every GPU can blend: four bits for nine classes and four
    /// for the bands. A road of 16 bands has 31 stripes across; with one pixel per stripe it is
    /// wider on the picture than any style allows.
    pub const MOST: usize = 16;

    /// The minimum width of a band, as a share of the road's width.
    pub const LEAST_SHARE: f32 = 0.01;

    /// A road of one colour.
    #[must_use]
    pub fn one(color: Rgb) -> Self {
        Self { bands: [RoadBand { width_share: 1.0, color }; Self::MOST], count: 1 }
    }

    /// A road of one colour with a line along its middle, whose width is a share below 1.
    pub(crate) fn with_center(mut self, center: RoadBand) -> Self {
        self.bands[1] = center;
        Self { count: 2, ..self }
    }

    /// A road of these bands, the widest first.
    ///
    /// # Errors
    /// When there are no bands or more than [`RoadBands::MOST`]; when the first band is not as wide
    /// as the road; when another band is not narrower than the previous one, or is narrower than
    /// [`RoadBands::LEAST_SHARE`].
    pub fn new(bands: &[RoadBand]) -> Result<Self, StyleError> {
        let Some(first) = bands.first().filter(|_| bands.len() <= Self::MOST) else {
            return Err(StyleError::BandCount { count: bands.len(), most: Self::MOST });
        };
        // Both comparisons also reject NaN.
        if !(1.0..=1.0).contains(&first.width_share) {
            return Err(StyleError::FirstBand { width: first.width_share });
        }
        for (number, pair) in (2..).zip(bands.windows(2)) {
            let (width, before) = (pair[1].width_share, pair[0].width_share);
            if !(Self::LEAST_SHARE..before).contains(&width) {
                return Err(StyleError::BandOrder { number, width, before });
            }
        }
        let mut all = Self::one(first.color);
        all.bands[..bands.len()].copy_from_slice(bands);
        all.count = bands.len();
        Ok(all)
    }

    /// All bands, the widest first.
    #[must_use]
    pub fn all(&self) -> &[RoadBand] {
        &self.bands[..self.count]
    }

    /// How many bands slip roads have: those that are at least half as wide as the road. So a slip
    /// road has no line along its middle.
    #[must_use]
    pub fn of_slip_roads(&self) -> usize {
        self.all().iter().filter(|band| band.width_share >= 0.5).count()
    }

    /// The dominant colour, for roads that have one colour only: tunnels, swatches, and roads that
    /// are too thin for their bands. If two colours cover the same width, the outer one counts.
    #[must_use]
    pub fn main_color(&self) -> Rgb {
        let bands = self.all();
        let inner = bands.iter().skip(1).map(|band| band.width_share).chain([0.0]);
        let seen = bands.iter().zip(inner).map(|(band, inner)| (band.width_share - inner, band));
        let most = seen.reduce(|most, next| if next.0 > most.0 { next } else { most });
        most.map_or(self.bands[0].color, |(_, band)| band.color)
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "road_bands_tests.rs"]
mod tests;
