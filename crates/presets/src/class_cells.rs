use std::collections::BTreeMap;

use corniche_roads::{ClassFilter, FunctionalRoadClass};

use crate::PresetError;

/// A filter from coarsest cells, in metres, by class number; a class left out is always shown.
///
/// # Errors
/// When a name is no class, a cell no length, or a class outlasts a more important one.
pub fn class_filter(cells_m: &BTreeMap<String, f64>) -> Result<ClassFilter, PresetError> {
    let mut class_max_cell_m = [None; FunctionalRoadClass::COUNT];
    for (class, &cell_m) in cells_m {
        // "07" and "+7" would be the same class twice, and one of the two lost.
        let slot = class
            .parse::<usize>()
            .ok()
            .filter(|number| number.to_string() == *class)
            .and_then(|number| class_max_cell_m.get_mut(number));
        *slot.ok_or_else(|| PresetError::Class { text: class.clone() })? = Some(cell_m);
    }
    Ok(ClassFilter::new(class_max_cell_m)?)
}

#[cfg(test)]
mod tests {
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
}
