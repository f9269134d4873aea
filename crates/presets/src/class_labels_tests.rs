//! The labels of road classes are the values in their table.

use super::*;
#[test]
fn classes_are_called_by_the_values_of_their_table() {
    assert_eq!(
        class_labels("default"),
        [
            "motorway",
            "trunk",
            "primary",
            "secondary",
            "tertiary",
            "unclassified",
            "residential, living street",
            "service, track",
            "footway, path"
        ]
    );
}

#[test]
fn a_class_without_a_known_value_has_its_number() {
    for preset in crate::frc_preset_names() {
        for (number, label) in class_labels(preset).iter().enumerate() {
            assert!(!label.is_empty());
            assert!(!label.starts_with("class") || *label == format!("class {number}"), "{label}");
        }
    }
    assert!(class_labels("here5").iter().any(|label| label.starts_with("class")));
}

#[test]
fn a_table_of_ones_own_has_numbers() {
    assert_eq!(class_labels("mine")[3], "class 3");
}
