//! Checks of the numbers that users give for pictures, flights and windows.

use std::ops::RangeInclusive;

use crate::{camera::Orientation, gpu::MAX_SAMPLES_PER_SIDE, viewpoint::CameraRequest};

/// A number from the user is out of its range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{name} of {value} is out of range; it must be {range}")]
pub struct OutOfRange {
    /// Name of the number, with its article.
    pub name: &'static str,
    /// The number.
    pub value: f64,
    /// The valid range, in words.
    pub range: &'static str,
}

/// Checks one number; NaN is out of every range. `range` is the range in words.
///
/// # Errors
/// When the number is not within `fits`.
pub fn within(
    name: &'static str,
    value: f64,
    fits: RangeInclusive<f64>,
    range: &'static str,
) -> Result<(), OutOfRange> {
    if fits.contains(&value) { Ok(()) } else { Err(OutOfRange { name, value, range }) }
}

/// Checks the numbers that set how finely the ground is drawn and how much its heights are
/// exaggerated. `cell_px` may be infinite.
///
/// # Errors
/// When a number is out of range.
pub fn check_ground(
    screen_space_error_px: f64,
    cell_px: f64,
    exaggeration: f64,
) -> Result<(), OutOfRange> {
    let any_above_0 = f64::MIN_POSITIVE..=f64::MAX;
    within("a screen-space error", screen_space_error_px, any_above_0, "above 0 pixels")?;
    within("a cell size", cell_px, f64::MIN_POSITIVE..=f64::INFINITY, "above 0 pixels")?;
    within("an exaggeration", exaggeration, 0.01..=100.0, "0.01 to 100")
}

/// Checks the number of samples along each side of a pixel.
///
/// # Errors
/// When it is 0 or too large.
pub fn check_supersampling(samples_per_side: u32) -> Result<(), OutOfRange> {
    let fits = 1.0..=f64::from(MAX_SAMPLES_PER_SIDE);
    within("supersampling", f64::from(samples_per_side), fits, "1 to 4")
}

/// Checks the numbers of a camera.
///
/// # Errors
/// When one of the numbers is out of range.
pub fn check_camera(camera: CameraRequest) -> Result<(), OutOfRange> {
    let pixel = |pixel_m| within("a pixel", pixel_m, 1e-3..=1e6, "1 mm to 1000 km");
    if let CameraRequest::OverviewFromAbove { pixel_m: Some(pixel_m) } = camera {
        return pixel(pixel_m);
    }
    if let CameraRequest::FromAbove { pixel_m, heading_deg, .. } = camera {
        pixel(pixel_m)?;
        return within("a heading", heading_deg, f64::MIN..=f64::MAX, "an angle in degrees");
    }
    let CameraRequest::LookAt { height_m, distance_m, orientation, .. } = camera else {
        return Ok(());
    };
    within("a height", height_m.unwrap_or_default(), -1e8..=1e8, "at most 100 000 km")?;
    let Orientation { heading_deg, pitch_deg } = orientation;
    within("a distance", distance_m, 1.0..=1e8, "1 m to 100 000 km")?;
    within("a heading", heading_deg, f64::MIN..=f64::MAX, "an angle in degrees")?;
    within("a pitch", pitch_deg, 0.0..=90.0, "0 (straight down) to 90 (level)")
}

#[cfg(test)]
#[path = "range_tests.rs"]
mod tests;
