//! Arguments that several commands share are parsed or rejected.

use super::*;

#[test]
fn classes_are_numbers_and_ranges() {
    let numbers = |text: &str| {
        let classes = parse_classes(text).ok()?;
        Some(classes.numbers().to_vec())
    };
    assert_eq!(numbers("0-8"), Some((0..9).collect()));
    assert_eq!(numbers("7, 0-2 ,1"), Some(vec![0, 1, 2, 7]));
    for wrong in ["", "9", "3-1", "-1", "0-", "a", "1;2", "0-4,"] {
        assert_eq!(numbers(wrong), None, "{wrong:?}");
    }
}

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
