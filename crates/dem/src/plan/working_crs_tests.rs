//! The standard latitude of a geographic DEM is its middle, rounded.

use super::*;

#[test]
fn the_standard_latitude_is_the_middle_to_half_a_degree() {
    let of = |min_y: f64, max_y: f64| {
        standard_latitude_deg(Bounds { min_x: 9.0, min_y, max_x: 10.0, max_y })
    };
    assert_eq!(of(47.0, 48.0), 47.5);
    assert_eq!(of(46.999_999_9, 48.000_000_1), 47.5);
    assert_eq!(of(47.0, 47.5), 47.0, "a tie goes towards the equator");
    assert_eq!(of(-47.5, -47.0), -47.0, "also in the south");
    assert_eq!(of(47.0, 47.500_01), 47.5);
    assert_eq!(of(-0.2, 0.1), 0.0);
}
