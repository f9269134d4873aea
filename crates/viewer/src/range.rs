//! Numbers that pictures and flights alike are asked for with.

use std::ops::RangeInclusive;

/// A number that was asked for and cannot be had.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{name} of {value} is out of range; it must be {range}")]
pub struct OutOfRange {
    /// Of what, with its article.
    pub name: &'static str,
    /// The number.
    pub value: f64,
    /// What fits, in words.
    pub range: &'static str,
}

/// Checks one number; what is not a number fits nowhere.
pub(crate) fn within(
    name: &'static str,
    value: f64,
    fits: RangeInclusive<f64>,
    range: &'static str,
) -> Result<(), OutOfRange> {
    if fits.contains(&value) { Ok(()) } else { Err(OutOfRange { name, value, range }) }
}

/// Checks what says how fine the ground is drawn and how high.
pub(crate) fn check_ground(
    screen_space_error_px: f64,
    exaggeration: f64,
) -> Result<(), OutOfRange> {
    let any_above_0 = f64::MIN_POSITIVE..=f64::MAX;
    within("a screen-space error", screen_space_error_px, any_above_0, "above 0 pixels")?;
    within("an exaggeration", exaggeration, 0.01..=100.0, "0.01 to 100")
}

/// Checks the samples per pixel along each side.
pub(crate) fn check_supersampling(samples_per_side: u32) -> Result<(), OutOfRange> {
    within("supersampling", f64::from(samples_per_side), 1.0..=4.0, "1 to 4")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_a_range_fit_and_what_is_no_number_does_not() {
        for (error_px, exaggeration, fits) in [
            (2.0, 1.0, true),
            (1e-300, 0.01, true),
            (1e300, 100.0, true),
            (0.0, 1.0, false),
            (-1.0, 1.0, false),
            (f64::INFINITY, 1.0, false),
            (f64::NAN, 1.0, false),
            (2.0, 0.009, false),
            (2.0, 101.0, false),
            (2.0, f64::NAN, false),
        ] {
            let checked = check_ground(error_px, exaggeration);
            assert_eq!(checked.is_ok(), fits, "{error_px}, {exaggeration}");
        }
        for (samples, fits) in [(0, false), (1, true), (4, true), (5, false)] {
            assert_eq!(check_supersampling(samples).is_ok(), fits, "{samples}");
        }
        let words = check_ground(2.0, 0.0).unwrap_err().to_string();
        assert_eq!(words, "an exaggeration of 0 is out of range; it must be 0.01 to 100");
    }
}
