//! The position of a node as the file gives it.

/// Longitude and latitude in whole 1e-7 degrees, OSM's own resolution, or one of two marks beyond
/// ±180°.
///
/// Fixed point as in libosmium's `Location` (`include/osmium/osm/location.hpp`): half the memory of
/// two f64.
pub(crate) type Location = [i32; 2];

/// The mark for an unknown position.
pub(crate) const MISSING: Location = [i32::MIN; 2];
/// The mark for a position that is not on Earth.
pub(crate) const OUT_OF_RANGE: Location = [i32::MAX; 2];

/// The coordinate that libosmium writes into ways with locations for missing and deleted nodes, in
/// nanodegrees (`undefined_coordinate` in `include/osmium/osm/location.hpp`, there in units of 1e-7
/// degrees).
const UNDEFINED_NANO_DEG: i64 = 100 * (i32::MAX as i64);

/// Rounds nanodegrees to a location.
pub(crate) fn location_from_nano(lon_nano_deg: i64, lat_nano_deg: i64) -> Location {
    if lon_nano_deg == UNDEFINED_NANO_DEG && lat_nano_deg == UNDEFINED_NANO_DEG {
        return MISSING;
    }
    let is_on_earth = lon_nano_deg.unsigned_abs() <= 180_000_000_000
        && lat_nano_deg.unsigned_abs() <= 90_000_000_000;
    let round = |nano_deg: i64| ((nano_deg + 50).div_euclid(100)) as i32;
    if is_on_earth { [round(lon_nano_deg), round(lat_nano_deg)] } else { OUT_OF_RANGE }
}

/// Returns longitude and latitude in degrees; `None` for the two marks.
pub(crate) fn degrees(location: Location) -> Option<[f64; 2]> {
    // Dividing rounds once; a factor of 1e-7 would round twice.
    (location != MISSING && location != OUT_OF_RANGE)
        .then(|| location.map(|part| f64::from(part) / 1e7))
}

#[cfg(test)]
#[path = "location_tests.rs"]
mod tests;
