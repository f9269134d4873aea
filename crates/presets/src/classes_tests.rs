//! Lists of classes are numbers and ranges.

use super::*;

#[test]
fn classes_are_numbers_and_ranges() {
    let numbers = |text| Classes::parse(text).map(|classes| classes.numbers().to_vec());
    assert_eq!(numbers("0-7").unwrap(), [0, 1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(numbers("8").unwrap(), [8]);
    assert_eq!(numbers("2, 0 ,1,1").unwrap(), [0, 1, 2]);
    assert_eq!(numbers("7-8,0-1").unwrap(), [0, 1, 7, 8]);
    for bad in ["", "9", "0-9", "3-1", "-1", "a", "0,", "0--2", "0-1-2"] {
        assert!(numbers(bad).unwrap_err().contains("0 to 8"), "{bad}");
    }
}

#[test]
fn a_settings_file_has_a_list_or_a_text() {
    let read = |text: &str| {
        let config = crate::Config::parse(&format!("[roads]\nclasses = {text}\n"));
        config.map(|config| config.roads.classes.unwrap().numbers().to_vec())
    };
    assert_eq!(read("\"0-2,8\"").unwrap(), [0, 1, 2, 8]);
    assert_eq!(read("[8, 0]").unwrap(), [0, 8]);
    for bad in ["[]", "[9]", "[-1]", "3", "\"all\""] {
        assert!(read(bad).is_err(), "{bad}");
    }
}
