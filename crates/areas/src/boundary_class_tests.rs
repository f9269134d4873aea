//! Administrative levels and protected areas have boundary classes, whose names and numbers lead
//! back to them.

use super::*;

fn class_of_tags(tags: &[(&str, &str)]) -> Option<BoundaryClass> {
    BoundaryClass::of_tags(tags)
}

#[test]
fn levels_and_protected_areas_are_classes() {
    let admin = |level| class_of_tags(&[("boundary", "administrative"), ("admin_level", level)]);
    assert_eq!(admin("2"), Some(BoundaryClass::Admin2));
    assert_eq!(admin("8"), Some(BoundaryClass::Admin8));
    for none in ["1", "9", "10", "0", "", "two", "4;6", "-2"] {
        assert_eq!(admin(none), None, "{none:?}");
    }
    assert_eq!(class_of_tags(&[("boundary", "administrative")]), None);
    for value in ["protected_area", "national_park"] {
        assert_eq!(class_of_tags(&[("boundary", value)]), Some(BoundaryClass::Protected));
    }
    assert_eq!(class_of_tags(&[("boundary", "postal_code"), ("admin_level", "4")]), None);
    assert_eq!(class_of_tags(&[("admin_level", "4")]), None);
}

#[test]
fn names_and_numbers_lead_back() {
    for (number, class) in (0..).zip(BoundaryClass::ALL) {
        assert_eq!(class.number(), number);
        assert_eq!(BoundaryClass::from_number(number), Some(class));
        assert_eq!(BoundaryClass::from_name(class.name()), Some(class));
    }
    assert_eq!(BoundaryClass::from_number(8), None);
}
