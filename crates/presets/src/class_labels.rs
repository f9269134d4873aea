//! Labels of the classes of the built-in FRC tables.

use corniche_roads::FunctionalRoadClass;

use crate::{frc_preset, parse_frc_table};

/// The label of each road class, 0 first, of the built-in FRC table with this name: see
/// [`FrcTable::class_labels`](corniche_roads::FrcTable::class_labels). For other tables, "class 5"
/// and so on.
#[must_use]
pub fn class_labels(frc_table: &str) -> [String; FunctionalRoadClass::COUNT] {
    let table = frc_preset(frc_table).and_then(|text| parse_frc_table(text).ok());
    table.map_or_else(
        || std::array::from_fn(|class| format!("class {class}")),
        |table| table.class_labels(),
    )
}

#[cfg(test)]
#[path = "class_labels_tests.rs"]
mod tests;
