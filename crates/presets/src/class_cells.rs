//! From which level on each road class is shown, read from settings.

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
#[path = "class_cells_tests.rs"]
mod tests;
