//! The part of a style's text about the ground.

use serde::Deserialize;

use crate::{
    Light, MOST_TINT_STOPS, StyleError, Tint, TintHeights,
    sheet_values::{Rgb8, within},
};

/// Minimum difference between consecutive shares of the tint. The shaders divide by it, in f32.
const LEAST_STEP: f64 = 0.001;

/// Minimum difference between consecutive heights of the tint, metres.
const LEAST_STEP_M: f64 = 1.0;

/// The direction of the light and its effect.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LightSheet {
    /// Compass direction of the light, clockwise from north, 0 to 360.
    pub(crate) azimuth_deg: f64,
    /// Angle of the light above the horizon, 0 to 90.
    pub(crate) altitude_deg: f64,
    /// How strongly slopes are shaded, 0 to 1.
    pub(crate) hillshade: f64,
    /// How much darker steep slopes are than level ground, 0 to 1.
    pub(crate) sky: f64,
    /// How many times steeper than they are the gentlest slopes are shaded, 1 to 10.
    pub(crate) gentle: f64,
    /// How strongly far valleys take the colour of the haze, 0 to 1.
    pub(crate) valley_haze: f64,
    /// In shadow, the ground's colour is multiplied by this colour.
    pub(crate) shadow: Rgb8,
    /// Slopes that face the light are tinted with this colour.
    pub(crate) sunlit: Rgb8,
}

impl LightSheet {
    /// Checks every number against its range.
    pub(crate) fn check(&self) -> Result<(), StyleError> {
        within("light.azimuth_deg", self.azimuth_deg, 0.0..=360.0)?;
        within("light.altitude_deg", self.altitude_deg, 0.0..=90.0)?;
        within("light.hillshade", self.hillshade, 0.0..=1.0)?;
        within("light.sky", self.sky, 0.0..=1.0)?;
        within("light.gentle", self.gentle, 1.0..=10.0)?;
        within("light.valley_haze", self.valley_haze, 0.0..=1.0)
    }
}

impl From<LightSheet> for Light {
    fn from(sheet: LightSheet) -> Self {
        Self {
            azimuth_deg: sheet.azimuth_deg,
            altitude_deg: sheet.altitude_deg,
            hillshade: sheet.hillshade as f32,
            sky: sheet.sky as f32,
            gentle: sheet.gentle as f32,
            valley_haze: sheet.valley_haze as f32,
            shadow: sheet.shadow.into(),
            sunlit: sheet.sunlit.into(),
        }
    }
}

/// A colour of the tint, at a share of the range of heights (0 to 1) or at a height in metres.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TintSheet {
    share: Option<f64>,
    height_m: Option<f64>,
    color: Rgb8,
}

/// Creates a tint. All entries must have shares, or all must have heights, and they must ascend.
pub(crate) fn tint(entries: &[TintSheet], by_climate: bool) -> Result<Tint, StyleError> {
    let count = entries.len();
    if !(2..=MOST_TINT_STOPS).contains(&count) {
        return Err(StyleError::TintCount { count, most: MOST_TINT_STOPS });
    }
    if entries.iter().any(|entry| entry.share.is_some() == entry.height_m.is_some()) {
        return Err(StyleError::TintUnit);
    }
    let shares: Option<Vec<f64>> = entries.iter().map(|entry| entry.share).collect();
    let heights_m: Option<Vec<f64>> = entries.iter().map(|entry| entry.height_m).collect();
    let (values, heights) = match (shares, heights_m) {
        (Some(shares), _) => {
            check_shares(&shares)?;
            (shares, TintHeights::Shares)
        }
        (_, Some(heights_m)) => {
            check_heights(&heights_m)?;
            let heights =
                if by_climate { TintHeights::MetresByClimate } else { TintHeights::Metres };
            (heights_m, heights)
        }
        (None, None) => return Err(StyleError::TintUnit),
    };
    if by_climate && heights == TintHeights::Shares {
        return Err(StyleError::TintClimate);
    }
    let stops = values.iter().zip(entries).map(|(at, entry)| (*at as f32, entry.color.into()));
    Ok(Tint { heights, stops: stops.collect() })
}

fn check_shares(shares: &[f64]) -> Result<(), StyleError> {
    let ends = [shares.first(), shares.last()].map(Option::<&f64>::copied);
    let ascend = shares.is_sorted_by(|a, b| a + LEAST_STEP <= *b);
    if ends == [Some(0.0), Some(1.0)] && ascend { Ok(()) } else { Err(StyleError::TintOrder) }
}

fn check_heights(heights_m: &[f64]) -> Result<(), StyleError> {
    for height_m in heights_m {
        within("tint.height_m", *height_m, -12_000.0..=9_000.0)?;
    }
    let ascend = heights_m.is_sorted_by(|a, b| a + LEAST_STEP_M <= *b);
    if ascend { Ok(()) } else { Err(StyleError::TintHeightOrder) }
}
