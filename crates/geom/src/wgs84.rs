//! Lengths and areas on the WGS84 ellipsoid, and lengths on others.

/// The semi-major axis in metres.
pub const SEMI_MAJOR_M: f64 = 6_378_137.0;
/// The square of the eccentricity, from a flattening of 1 / 298.257223563.
pub const ECCENTRICITY_2: f64 = FLATTENING * (2.0 - FLATTENING);
const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// The radius of the parallel and the radius of curvature of the meridian at a latitude, in metres:
/// the lengths of a radian of longitude and of a radian of latitude.
#[must_use]
pub fn radii_m(latitude_deg: f64) -> [f64; 2] {
    radii_of_m(SEMI_MAJOR_M, ECCENTRICITY_2, latitude_deg)
}

/// The same radii on an ellipsoid with a given semi-major axis and square of the eccentricity.
///
/// Source: Snyder 1987, *Map Projections: A Working Manual*, equations 4-18 to 4-21.
#[must_use]
pub fn radii_of_m(semi_major_m: f64, eccentricity_2: f64, latitude_deg: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(latitude_deg.to_radians());
    let w_2 = 1.0 - eccentricity_2 * sin * sin;
    let across_m = semi_major_m / w_2.sqrt();
    [across_m * cos, across_m * (1.0 - eccentricity_2) / w_2]
}

/// The distance between two positions, [longitude, latitude] in degrees, by the radii at the mean
/// latitude.
///
/// The relative difference from the geodesic is about (distance / earth's radius)² / 24, and more
/// near a pole: 10⁻⁷ for ten kilometres.
#[must_use]
pub fn short_distance_m(from_deg: [f64; 2], to_deg: [f64; 2]) -> f64 {
    let [parallel_m, meridian_m] = radii_m(f64::midpoint(from_deg[1], to_deg[1]));
    let east = radians_east(from_deg, to_deg);
    let north = (to_deg[1] - from_deg[1]).to_radians();
    (parallel_m * east).hypot(meridian_m * north)
}

/// The area inside a closed line on the ellipsoid, in square metres; negative for a clockwise line.
/// The first position is not repeated at the end. Positions are [longitude, latitude] in degrees,
/// and between neighbours the line goes the shorter way around the earth.
///
/// Exact for lines that are straight in the cylindrical equal-area projection. For lines that are
/// straight in degrees, or geodesics, the relative difference is about (side / earth's radius)². No
/// line may go around a pole.
///
/// Source: Snyder 1987, *Map Projections: A Working Manual*, equation 3-12 (q, to which areas
/// between latitudes are proportional).
#[must_use]
pub fn area_m2(ring_deg: &[[f64; 2]]) -> f64 {
    let next = ring_deg.iter().cycle().skip(1);
    let doubled: f64 = ring_deg.iter().zip(next).map(|(&from, &to)| doubled_beside(from, to)).sum();
    half_of_doubled_m2(doubled)
}

/// The contribution to [`area_m2`] of the side between two corners.
#[must_use]
pub fn area_beside_m2(from_deg: [f64; 2], to_deg: [f64; 2]) -> f64 {
    half_of_doubled_m2(doubled_beside(from_deg, to_deg))
}

fn doubled_beside(from_deg: [f64; 2], to_deg: [f64; 2]) -> f64 {
    radians_east(from_deg, to_deg)
        * (equal_area_latitude(from_deg[1]) + equal_area_latitude(to_deg[1]))
}

/// The distance in radians of a position to the east of another one, the shorter way around the
/// earth.
fn radians_east(from_deg: [f64; 2], to_deg: [f64; 2]) -> f64 {
    let turns = (to_deg[0] - from_deg[0]) / 360.0;
    ((turns - turns.round()) * 360.0).to_radians()
}

fn half_of_doubled_m2(doubled: f64) -> f64 {
    // In the eastward direction, the area between the line and the equator counts as outside.
    -doubled / 2.0 * SEMI_MAJOR_M * SEMI_MAJOR_M / 2.0
}

/// Snyder's q: areas between two latitudes are proportional to its difference.
fn equal_area_latitude(latitude_deg: f64) -> f64 {
    let sin = latitude_deg.to_radians().sin();
    let e = ECCENTRICITY_2.sqrt();
    (1.0 - ECCENTRICITY_2) * (sin / (1.0 - ECCENTRICITY_2 * sin * sin) + (e * sin).atanh() / e)
}

#[cfg(test)]
#[path = "wgs84_tests.rs"]
mod tests;
