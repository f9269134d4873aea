//! The ends of a range are within it, and NaN is not.

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
        let checked = check_ground(error_px, 2.0, exaggeration);
        assert_eq!(checked.is_ok(), fits, "{error_px}, {exaggeration}");
    }
    for (cell_px, fits) in [(1e-300, true), (f64::INFINITY, true), (0.0, false), (f64::NAN, false)]
    {
        assert_eq!(check_ground(2.0, cell_px, 1.0).is_ok(), fits, "{cell_px}");
    }
    for (samples, fits) in [(0, false), (1, true), (4, true), (5, false)] {
        assert_eq!(check_supersampling(samples).is_ok(), fits, "{samples}");
    }
    let words = check_ground(2.0, 2.0, 0.0).unwrap_err().to_string();
    assert_eq!(words, "an exaggeration of 0 is out of range; it must be 0.01 to 100");
}
