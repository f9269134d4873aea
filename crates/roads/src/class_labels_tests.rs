//! The classes of a table are labelled by their values, well-known values first.

use crate::FrcTable;

#[test]
fn classes_are_called_by_what_their_table_puts_there() {
    let classes = [
        ("via_ferrata", 0),
        ("path", 1),
        ("footway", 1),
        ("steps", 1),
        ("cycleway", 1),
        ("goat_track", 3),
        ("alm", 3),
        ("zipline", 3),
        ("motorway", 8),
        ("raceway", 8),
    ];
    let long = "x".repeat(65);
    let classes = classes.map(|(value, class)| (value.to_owned(), class)).into_iter();
    let classes = classes.chain([(long, 4)]).collect();
    let table = FrcTable::new("hiking", classes, vec!["pier".to_owned()], 8).unwrap();
    let labels = table.class_labels();
    assert_eq!(
        labels,
        [
            "via ferrata",
            "footway, path",
            "class 2",
            "alm, goat track",
            "class 4",
            "class 5",
            "class 6",
            "class 7",
            "motorway"
        ]
    );
    assert!(labels.iter().all(|label| label.chars().count() <= FrcTable::LONGEST_LABEL));
    // A choice of classes changes no label.
    assert_eq!(table.with_classes(&[1]).unwrap().class_labels(), labels);
}
