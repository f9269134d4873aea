//! What people call the classes of the FRC tables that come with the program.

use corniche_roads::FunctionalRoadClass;

use crate::{frc_preset, parse_frc_table};

/// What people call the roads of each class, 0 first, with the FRC table of this name that comes with the program: see
/// [`FrcTable::class_labels`](corniche_roads::FrcTable::class_labels). "class 5" for tables that do not come with it.
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
