//! Lengths and areas on the ellipsoid agree with published tables.

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

/// Half of the whole ellipsoid is between the equator and a pole: its area has a closed form.
#[test]
fn areas_add_up_to_the_ellipsoid() {
    // One eighth of the earth, with a side along the pole.
    let octant = area_m2(&[[0.0, 0.0], [90.0, 0.0], [90.0, 90.0], [0.0, 90.0]]);
    // Moritz 2000, Geodetic Reference System 1980, gives 510 065 600 km² for an ellipsoid that
    // differs by 1e-10.
    assert!((8.0 * octant / 5.100_656_217e14 - 1.0).abs() < 1e-8, "{}", 8.0 * octant);
}

/// A small square has the area of its sides; in reverse order it is negative; across 180 degrees it
/// is the same.
#[test]
fn areas_of_small_squares_are_those_of_their_sides() {
    for [lon, lat] in [[9.5, 47.0], [-70.0, -55.0], [179.9995, 10.0]] {
        let (east, north) = (lon + 1e-3, lat + 1e-3);
        let east = if east > 180.0 { east - 360.0 } else { east };
        let ring = [[lon, lat], [east, lat], [east, north], [lon, north]];
        let width_m = short_distance_m([lon, lat + 5e-4], [east, lat + 5e-4]);
        let height_m = short_distance_m([lon, lat], [lon, north]);
        let ratio = area_m2(&ring) / (width_m * height_m);
        assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
        let turned: Vec<_> = ring.into_iter().rev().collect();
        assert!((area_m2(&turned) + area_m2(&ring)).abs() < 1e-6 * area_m2(&ring));
    }
}
