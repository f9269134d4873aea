//! Road classes disappear in the order of their importance.

use super::*;

fn cells(entries: &[(&str, f64)]) -> BTreeMap<String, f64> {
    entries.iter().map(|&(class, cell_m)| (class.to_owned(), cell_m)).collect()
}

#[test]
fn classes_vanish_in_the_order_of_their_importance() {
    let filter = class_filter(&cells(&[("7", 30.0), ("8", 15.0)])).unwrap();
    assert_eq!(filter.class_max_cell_m()[6..], [None, Some(30.0), Some(15.0)]);
    assert!(class_filter(&cells(&[("7", 30.0)])).is_err(), "8 would outlast 7");
    assert!(class_filter(&cells(&[("8", f64::NAN)])).is_err());
}

#[test]
fn a_class_has_one_name() {
    for name in ["9", "-1", "08", "+8", "", "motorway", "99999999999999999999"] {
        let refused = class_filter(&cells(&[(name, 30.0)]));
        assert!(matches!(refused, Err(PresetError::Class { .. })), "{name}");
    }
}
