//! Bounds are four degrees or a word, in files and on the command line.

use super::*;

#[test]
fn bounds_are_four_degrees_or_a_word() {
    let degrees = |text| BoundsChoice::parse(text).unwrap();
    assert_eq!(degrees("9.4,47,9.7,47.3"), BoundsChoice::Degrees([9.4, 47.0, 9.7, 47.3]));
    assert_eq!(degrees(" -180 , -90,180, 90"), BoundsChoice::Degrees([-180.0, -90.0, 180.0, 90.0]));
    // Across 180°.
    assert_eq!(degrees("170,-20,-170,-10"), BoundsChoice::Degrees([170.0, -20.0, -170.0, -10.0]));
    assert_eq!(degrees("osm"), BoundsChoice::Osm);
    for (text, word) in [
        ("", "write west"),
        ("1,2,3", "write west"),
        ("1,2,3,4,5", "write west"),
        ("a,2,3,4", "write west"),
        ("OSM.pbf", "write west"),
        ("1,2,3,nan", "south must"),
        ("nan,2,3,4", "longitudes"),
        ("181,2,3,4", "longitudes"),
        ("1,5,3,4", "south must"),
        ("1,4,3,4", "south must"),
        ("1,2,3,91", "south must"),
        ("7,2,7,4", "are equal"),
    ] {
        let said = BoundsChoice::parse(text).unwrap_err();
        assert!(said.contains(word), "{text}: {said}");
    }
}

#[test]
fn a_settings_file_has_a_list_or_a_text() {
    let read = |text: &str| {
        crate::Config::parse(&format!("[terrain]\nbounds = {text}\n"))
            .map(|config| config.terrain.bounds)
    };
    assert_eq!(read("\"osm\"").unwrap(), Some(BoundsChoice::Osm));
    let degrees = Some(BoundsChoice::Degrees([9.0, 47.0, 10.0, 47.5]));
    assert_eq!(read("[9, 47, 10, 47.5]").unwrap(), degrees);
    assert_eq!(read("\"9,47,10,47.5\"").unwrap(), degrees);
    for bad in ["[9, 47, 10]", "9", "[9, 48, 10, 47]", "\"everything\""] {
        assert!(read(bad).is_err(), "{bad}");
    }
}
