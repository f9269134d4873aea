//! The coarsest cell size at which each road class is shown, from settings.

use std::collections::BTreeMap;

use corniche_roads::{ClassFilter, FunctionalRoadClass};

use crate::PresetError;

/// Creates a filter from coarsest cells, in metres, by class number; a class that is not listed is
/// always shown.
///
/// # Errors
/// When a name is not a class, a cell is not a length, or a class is shown on coarser levels than a
/// more important one.
pub fn class_filter(cells_m: &BTreeMap<String, f64>) -> Result<ClassFilter, PresetError> {
    let mut class_max_cell_m = [None; FunctionalRoadClass::COUNT];
    for (class, &cell_m) in cells_m {
        // "07" and "+7" would be the same class twice, and one of the two entries would be lost.
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
#[path = "class_cells_tests.rs"]
mod tests;
