//! Positions on the earth as users write them.

/// Why a text is not a valid position. The message says what to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
pub enum LonLatError {
    #[error("write longitude,latitude like 9.52,47.14")]
    Form,
    #[error("longitude comes first and must be within ±360 degrees, latitude within ±90")]
    Range,
}

/// Parses longitude and latitude, in degrees (WGS84), from a text such as `9.52,47.14`; spaces
/// around the numbers are allowed.
///
/// # Errors
/// When the text is not two numbers with a comma between them, or the position does not exist.
pub fn parse_lon_lat(text: &str) -> Result<[f64; 2], LonLatError> {
    let (lon, lat) = text.split_once(',').ok_or(LonLatError::Form)?;
    let number = |text: &str| text.trim().parse().map_err(|_| LonLatError::Form);
    let (lon, lat) = (number(lon)?, number(lat)?);
    // This form also rejects NaN.
    if (-360.0..=360.0).contains(&lon) && (-90.0..=90.0).contains(&lat) {
        Ok([lon, lat])
    } else {
        Err(LonLatError::Range)
    }
}

#[cfg(test)]
#[path = "lon_lat_tests.rs"]
mod tests;
