//! Arguments that several commands share are parsed or rejected.

use super::*;

#[test]
fn bounds_are_four_numbers_that_make_a_rectangle() {
    assert_eq!(
        parse_bounds("179.5,-17,-179.5, -16"),
        Ok(DegreeBounds::new([179.5, -17.0, -179.5, -16.0]).unwrap())
    );
    for wrong in ["", "1,2,3", "1,2,3,4,5", "1,2,3,x", "1,4,3,2", "1,2,1,4", "1,2,300,4", "osm"] {
        assert!(parse_bounds(wrong).is_err(), "{wrong:?}");
    }
}
