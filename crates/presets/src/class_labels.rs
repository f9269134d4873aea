//! What people call the roads of each class, for legends and panels.

use corniche_roads::{FrcTable, FunctionalRoadClass};

use crate::{frc_preset, parse_frc_table};

/// Values of `highway` that people know, the most important first.
const KNOWN: [&str; 14] = [
    "motorway",
    "trunk",
    "primary",
    "secondary",
    "tertiary",
    "unclassified",
    "residential",
    "living_street",
    "service",
    "track",
    "pedestrian",
    "cycleway",
    "footway",
    "path",
];

/// More values than these make a label too long.
const MOST_VALUES: usize = 2;

/// What people call the roads of each class, 0 first: the values of `highway` that the FRC table of this name puts there. "class 5"
/// where it puts none that is known, and for tables that do not come with the program.
#[must_use]
pub fn class_labels(frc_table: &str) -> [String; FunctionalRoadClass::COUNT] {
    let table = frc_preset(frc_table).and_then(|text| parse_frc_table(text).ok());
    std::array::from_fn(|class| {
        let names = table.iter().flat_map(|table| names(table, class));
        let names: Vec<String> = names.take(MOST_VALUES).collect();
        if names.is_empty() { format!("class {class}") } else { names.join(", ") }
    })
}

/// The known values of a class.
fn names(table: &FrcTable, class: usize) -> impl Iterator<Item = String> {
    KNOWN
        .into_iter()
        .filter(move |known| {
            table.values().any(|(value, found)| {
                value == *known && found.is_some_and(|found| usize::from(found.number()) == class)
            })
        })
        .map(|known| known.replace('_', " "))
}

#[cfg(test)]
#[path = "class_labels_tests.rs"]
mod tests;
