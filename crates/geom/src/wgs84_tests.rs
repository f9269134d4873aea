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
