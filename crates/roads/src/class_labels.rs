//! Labels for the classes of a table, for legends and panels.

use crate::{FrcTable, FunctionalRoadClass};

/// Well-known values of `highway`, the most important first.
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
    "footway",
    "path",
    "cycleway",
];

/// The maximum number of values in a label; more values would make it too long.
const MOST_VALUES: usize = 2;

/// The maximum number of characters of a value; longer values are omitted.
const MOST_CHARACTERS: usize = 64;

impl FrcTable {
    /// The maximum number of characters in a label.
    pub const LONGEST_LABEL: usize = MOST_VALUES * (MOST_CHARACTERS + 2);

    /// Returns a label for each class, from class 0 on: the values of `highway` that the table
    /// assigns to the class, well-known values first. A class without values gets a label such as
    /// "class 5".
    #[must_use]
    pub fn class_labels(&self) -> [String; FunctionalRoadClass::COUNT] {
        std::array::from_fn(|class| {
            let of_class: Vec<&str> = self
                .values()
                .filter(|(value, _)| value.chars().count() <= MOST_CHARACTERS)
                .filter(|(_, found)| {
                    found.is_some_and(|found| usize::from(found.number()) == class)
                })
                .map(|(value, _)| value)
                .collect();
            let known: Vec<&str> =
                KNOWN.into_iter().filter(|known| of_class.contains(known)).collect();
            let names = if known.is_empty() { of_class } else { known };
            let names: Vec<String> =
                names.into_iter().take(MOST_VALUES).map(|name| name.replace('_', " ")).collect();
            if names.is_empty() { format!("class {class}") } else { names.join(", ") }
        })
    }
}

#[cfg(test)]
#[path = "class_labels_tests.rs"]
mod tests;
