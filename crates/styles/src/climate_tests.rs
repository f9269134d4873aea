//! The snow line has the values of its table and is symmetric about the equator.

use super::*;

#[test]
fn the_snow_line_meets_its_table_and_is_the_same_north_and_south() {
    for (latitude_deg, height_m) in SNOW_LINE {
        assert!((snow_line_m(latitude_deg) - height_m).abs() < 1e-9, "{latitude_deg}");
        assert!((snow_line_m(-latitude_deg) - height_m).abs() < 1e-9, "-{latitude_deg}");
    }
    assert!((snow_line_m(51.0) - 2350.0).abs() < 1e-9, "halfway between two values");
    assert!((snow_line_m(f64::INFINITY) - 300.0).abs() < 1e-9);
}

#[test]
fn heights_are_as_written_at_the_reference_latitude() {
    assert!((height_factor(REFERENCE_LATITUDE_DEG) - 1.0).abs() < 1e-12);
    assert!(height_factor(0.0) > 1.5 && height_factor(70.0) < 0.5);
}
