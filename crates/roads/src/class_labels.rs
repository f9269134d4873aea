//! What people call the roads of each class of a table, for legends and panels.

use crate::{FrcTable, FunctionalRoadClass};

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
    "footway",
    "path",
    "cycleway",
];

/// More values than these make a label too long.
const MOST_VALUES: usize = 2;

/// Longer values are not named.
const MOST_CHARACTERS: usize = 64;

impl FrcTable {
    /// The most characters of a label.
    pub const LONGEST_LABEL: usize = MOST_VALUES * (MOST_CHARACTERS + 2);

    /// What people call the roads of each class, 0 first: the values of `highway` that the table puts there, those that people know
    /// before others. "class 5" where it puts none.
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
