//! Positions in degrees are parsed or rejected.

use super::*;

#[test]
fn positions_are_read_or_refused() {
    assert_eq!(parse_lon_lat("-9.5, 47"), Ok([-9.5, 47.0]));
    assert_eq!(parse_lon_lat(" 9.52,47.14 "), Ok([9.52, 47.14]));
    for text in ["", "47", "9.5 47", "9.5,47,3", "9,5,47,1", "9.5° E, 47° N", ",47"] {
        assert_eq!(parse_lon_lat(text), Err(LonLatError::Form), "{text:?}");
    }
    for text in ["9,147", "361,0", "nan,47", "9,inf"] {
        assert_eq!(parse_lon_lat(text), Err(LonLatError::Range), "{text:?}");
    }
}
