//! The style of the ground: its colours by height, and the light on it.

use crate::{Rgb, climate};
use serde::{Deserialize, Serialize};

/// A stop of the height tint: a height in the unit of [`TintHeights`], and the colour there.
pub type TintStop = (f32, Rgb);

/// How many stops a height tint may have.
pub const MOST_TINT_STOPS: usize = 12;

/// What the heights of a tint's stops mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum TintHeights {
    /// Shares of the package's range of heights, 0 to 1.
    Shares,
    /// Metres, everywhere on earth.
    Metres,
    /// Metres at [`climate::REFERENCE_LATITUDE_DEG`]; elsewhere, heights above 0 are moved like the
    /// snow line.
    MetresByClimate,
}

/// Colours of the ground by its height.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tint {
    /// What the heights of the stops mean.
    pub heights: TintHeights,
    /// The stops, lowest first: at least two and at most [`MOST_TINT_STOPS`].
    pub stops: Vec<TintStop>,
}

impl Tint {
    /// Returns the stops with heights in metres, for a package with this range of heights at this
    /// latitude.
    #[must_use]
    pub fn stops_m(&self, range_m: [f64; 2], latitude_deg: f64) -> Vec<TintStop> {
        let [lowest_m, highest_m] = range_m;
        let span_m = (highest_m - lowest_m).max(1.0);
        let by_climate = climate::height_factor(latitude_deg);
        let metres = |height: f32| match self.heights {
            TintHeights::Shares => (lowest_m + f64::from(height) * span_m) as f32,
            TintHeights::MetresByClimate if height > 0.0 => (f64::from(height) * by_climate) as f32,
            TintHeights::Metres | TintHeights::MetresByClimate => height,
        };
        self.stops.iter().map(|(height, color)| (metres(*height), *color)).collect()
    }
}

impl Tint {
    /// Returns the colour at a height, for a package with this range of heights at this latitude.
    /// Colours are linear between stops.
    #[must_use]
    pub fn color_at(&self, height_m: f64, range_m: [f64; 2], latitude_deg: f64) -> Rgb {
        let stops = self.stops_m(range_m, latitude_deg);
        let mut color = stops.first().map_or([0.0; 3], |stop| stop.1);
        for pair in stops.windows(2) {
            let [(low_m, _), (high_m, above)] = [pair[0], pair[1]];
            let share = ((height_m as f32 - low_m) / (high_m - low_m)).clamp(0.0, 1.0);
            color = [0, 1, 2].map(|k: usize| color[k] + (above[k] - color[k]) * share);
        }
        color
    }
}

/// The light on the ground.
///
/// Shading follows the rules of Imhof, *Cartographic Relief Presentation* (1965; English edition
/// 1982), chapters 9 and 10: light from the upper left that turns where a slope runs parallel to
/// it, darker steep slopes, shadow colours that are not grey, and less contrast in valleys.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// Compass direction the light comes from.
    pub azimuth_deg: f64,
    /// Height of the light above the horizon.
    pub altitude_deg: f64,
    /// How strongly slopes are shaded, 0 to 1.
    pub hillshade: f32,
    /// How much darker steep slopes are than level ground, whichever way they face, 0 to 1. This
    /// models the light of the sky.
    pub sky: f32,
    /// How many times steeper than they are the gentlest slopes are shaded, 1 to 10. Steep slopes
    /// are shaded as they are.
    pub gentle: f32,
    /// How strongly far valleys take the colour of the haze, 0 to 1.
    pub valley_haze: f32,
    /// In shadow, the ground's colour is multiplied by this colour.
    pub shadow: Rgb,
    /// Slopes that face the light are tinted with this colour.
    pub sunlit: Rgb,
}
