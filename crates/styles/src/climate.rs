//! Height of the snow line by latitude.

/// The latitude to which the heights of a tint refer: that of the central Alps.
pub const REFERENCE_LATITUDE_DEG: f64 = 47.0;

/// The snow line: latitude north or south of the equator, and metres.
///
/// The values are rounded from observations of mountain ranges: 4700 m at the equator (Mount Kenya,
/// New Guinea), 5000 to 6000 m in the dry subtropics (Himalaya, Andes), 2900 m in the central Alps,
/// 1200 m at the polar circle in Scandinavia, 450 m in Svalbard. Real values vary by a thousand
/// metres with rain and snow; this is precise enough for a tint.
const SNOW_LINE: [(f64, f64); 8] = [
    (0.0, 4700.0),
    (20.0, 5300.0),
    (30.0, 5300.0),
    (REFERENCE_LATITUDE_DEG, 2900.0),
    (55.0, 1800.0),
    (67.0, 1200.0),
    (78.0, 450.0),
    (90.0, 300.0),
];

/// Height of the snow line, metres; linear between the values of the table.
#[must_use]
pub fn snow_line_m(latitude_deg: f64) -> f64 {
    let latitude_deg = latitude_deg.abs().min(90.0);
    let next = SNOW_LINE.partition_point(|(known_deg, _)| *known_deg < latitude_deg);
    let [(low_deg, low_m), (high_deg, high_m)] =
        [next.saturating_sub(1), next].map(|k| SNOW_LINE[k.min(SNOW_LINE.len() - 1)]);
    if high_deg > low_deg {
        low_m + (high_m - low_m) * (latitude_deg - low_deg) / (high_deg - low_deg)
    } else {
        low_m
    }
}

/// The factor by which the heights of a tint are multiplied at this latitude.
#[must_use]
pub fn height_factor(latitude_deg: f64) -> f64 {
    snow_line_m(latitude_deg) / snow_line_m(REFERENCE_LATITUDE_DEG)
}

#[cfg(test)]
#[path = "climate_tests.rs"]
mod tests;
