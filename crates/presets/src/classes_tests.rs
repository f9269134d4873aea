//! Lists of classes are numbers, ranges and names.

use super::*;

/// The numbers of the classes of a list, with the labels of the default table.
fn numbers(classes: &Classes) -> Result<Vec<u8>, String> {
    let table = crate::parse_frc_table(crate::frc_preset("default").unwrap()).unwrap();
    let classes = classes.classes(Some(&table), &table.class_labels());
    classes.map(|list| list.iter().map(|of| of.number()).collect()).map_err(|e| e.to_string())
}

#[test]
fn classes_are_numbers_ranges_and_names() {
    let read = |text| Classes::parse(text).and_then(|classes| numbers(&classes));
    assert_eq!(read("0-7").unwrap(), [0, 1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(read("8").unwrap(), [8]);
    assert_eq!(read("2, 0 ,1,1").unwrap(), [0, 1, 2]);
    assert_eq!(read("7-8,0-1").unwrap(), [0, 1, 7, 8]);
    assert_eq!(read("primary, motorway,1").unwrap(), [0, 1, 2]);
    assert_eq!(read("cycleway").unwrap(), [8]);
    let both = ["living_street", "living street", "residential"];
    assert!(both.map(read).iter().all(|found| *found == read("residential")));
    for bad in ["", "9", "0-9", "3-1", "-1", "0,", "0--2", "0-1-2"] {
        assert!(read(bad).unwrap_err().contains("0 to 8"), "{bad}");
    }
    // Without a table, labels alone have names.
    let cycleway = Classes::parse("cycleway").unwrap();
    assert!(cycleway.classes(None, &crate::class_labels("default")).is_err());
    let unknown = read("0,motorways").unwrap_err();
    assert!(unknown.contains("\"motorways\"") && unknown.contains("motorway; trunk"), "{unknown}");
}

#[test]
fn a_settings_file_has_a_list_or_a_text() {
    let read = |text: &str| {
        let config = crate::Config::parse(&format!("[roads]\nclasses = {text}\n"));
        config.map(|config| numbers(&config.roads.classes.unwrap()).unwrap())
    };
    assert_eq!(read("\"0-2,8\"").unwrap(), [0, 1, 2, 8]);
    assert_eq!(read("[8, 0]").unwrap(), [0, 8]);
    assert_eq!(read("[8, \"motorway\"]").unwrap(), [0, 8]);
    for bad in ["[]", "[9]", "[-1]", "3", "\"-\""] {
        assert!(read(bad).is_err(), "{bad}");
    }
}
