//! The built-in area tables are valid, and invalid texts are rejected.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use corniche_areas::AreaClass;
use corniche_presets::{area_preset, area_preset_names, parse_area_table};

#[test]
fn each_preset_is_a_table_of_its_name_with_all_classes() {
    for name in area_preset_names() {
        let table = parse_area_table(area_preset(name).unwrap()).unwrap();
        assert_eq!(table.name(), name);
        for class in AreaClass::ALL.into_iter().filter(|&class| class != AreaClass::Sea) {
            assert!(table.tags().any(|(.., of_tag)| of_tag == class), "{class}");
        }
    }
}

#[test]
fn a_reservoir_in_a_wood_is_water_whatever_tag_comes_first() {
    let table = parse_area_table(area_preset("default").unwrap()).unwrap();
    assert_eq!(
        table.classify(&[("landuse", "forest"), ("natural", "water")]),
        Some(AreaClass::Water)
    );
    assert_eq!(table.classify(&[("landuse", "forest")]), Some(AreaClass::Forest));
    assert_eq!(table.classify(&[("building", "yes")]), None);
}

#[test]
fn texts_that_are_no_table_are_refused_with_what_is_wrong() {
    for (text, message) in [
        (
            "name = 'a'\n[[area]]\nclass = 'lake'\ntags = ['natural=water']",
            "\"lake\" is not a class",
        ),
        ("name = 'a'\n[[area]]\nclass = 'water'\ntags = ['natural']", "key=value"),
        ("name = 'a'\narea = []", "lists no tags"),
        ("name = 'a'\ncolour = 'blue'\narea = []", "unknown field"),
    ] {
        let error = parse_area_table(text).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
}
