//! Lengths on the WGS84 ellipsoid, and on others.

/// Semi-major axis.
pub const SEMI_MAJOR_M: f64 = 6_378_137.0;
/// Square of the eccentricity, from a flattening of 1 / 298.257223563.
pub const ECCENTRICITY_2: f64 = FLATTENING * (2.0 - FLATTENING);
const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// Radius of the parallel and radius of curvature of the meridian at a latitude, metres: what a radian of longitude and
/// one of latitude are long there.
#[must_use]
pub fn radii_m(latitude_deg: f64) -> [f64; 2] {
    radii_of_m(SEMI_MAJOR_M, ECCENTRICITY_2, latitude_deg)
}

/// The same on an ellipsoid by its semi-major axis and the square of its eccentricity.
///
/// Source: Snyder 1987, *Map Projections: A Working Manual*, equations 4-18 to 4-21.
#[must_use]
pub fn radii_of_m(semi_major_m: f64, eccentricity_2: f64, latitude_deg: f64) -> [f64; 2] {
    let (sin, cos) = latitude_deg.to_radians().sin_cos();
    let w_2 = 1.0 - eccentricity_2 * sin * sin;
    let across_m = semi_major_m / w_2.sqrt();
    [across_m * cos, across_m * (1.0 - eccentricity_2) / w_2]
}

/// Distance of two positions, [longitude, latitude] in degrees, by the radii at the latitude halfway between them.
///
/// Off the geodesic by a part of (distance / earth's radius)² / 24 or so, more beside a pole: 10⁻⁷ of ten kilometres.
#[must_use]
pub fn short_distance_m(from_deg: [f64; 2], to_deg: [f64; 2]) -> f64 {
    let [parallel_m, meridian_m] = radii_m(f64::midpoint(from_deg[1], to_deg[1]));
    let turns = (to_deg[0] - from_deg[0]) / 360.0;
    // The shorter way around the earth.
    let east = ((turns - turns.round()) * 360.0).to_radians();
    let north = (to_deg[1] - from_deg[1]).to_radians();
    (parallel_m * east).hypot(meridian_m * north)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Snyder 1987, table 3, and the quarter meridian of WGS84 (10 001 965.729 m).
    #[test]
    fn degrees_are_as_long_as_the_tables_say() {
        let [parallel_m, meridian_m] = radii_m(45.0).map(f64::to_radians);
        assert!((parallel_m - 78_846.8).abs() < 0.1 && (meridian_m - 111_131.8).abs() < 0.1);
        let quarter_m: f64 = (0..900)
            .map(|k| f64::from(k) / 10.0)
            .map(|lat| short_distance_m([9.0, lat], [9.0, lat + 0.1]))
            .sum();
        assert!((quarter_m - 10_001_965.729).abs() < 0.1, "{quarter_m}");
    }

    #[test]
    fn the_shorter_way_goes_over_the_antimeridian() {
        let across_m = short_distance_m([179.9, 10.0], [-179.9, 10.0]);
        assert!((across_m - short_distance_m([0.0, 10.0], [0.2, 10.0])).abs() < 1e-3);
    }
}
