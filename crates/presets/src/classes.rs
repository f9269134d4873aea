//! Lists of functional road classes, as text and as a setting.

use corniche_roads::{FrcTable, FunctionalRoadClass};
use serde::{Deserialize, Deserializer};

/// Road classes by number (`0-4,7`) and by name (`motorway`); at least one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Classes(Vec<ClassEntry>);

/// An entry of a list of classes.
#[derive(Debug, Clone, PartialEq, Eq)]
enum ClassEntry {
    /// The first and the last number of a range.
    Range(u8, u8),
    /// A value of `highway`, or a name in a label.
    Name(String),
}

/// The reason why a list of classes does not fit a table.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no class is called {name:?}; the classes are {}", labels.join("; "))]
pub struct UnknownClass {
    name: String,
    labels: Vec<String>,
}

impl Classes {
    /// Parses numbers, ranges and names, such as `0-7`, `0,1,2` or `motorway,trunk,5`.
    ///
    /// # Errors
    /// When it is not such a list, or has a number above 8.
    pub fn parse(text: &str) -> Result<Self, String> {
        let entry = |part: &str| -> Option<ClassEntry> {
            if part.starts_with(char::is_alphabetic) {
                return Some(ClassEntry::Name(part.to_owned()));
            }
            let (first, last) = part.split_once('-').unwrap_or((part, part));
            let (first, last) = (first.trim().parse().ok()?, last.trim().parse().ok()?);
            let is_range = first <= last && FunctionalRoadClass::new(last).is_some();
            is_range.then_some(ClassEntry::Range(first, last))
        };
        let entries: Option<Vec<_>> = text.split(',').map(str::trim).map(entry).collect();
        entries.map(Self).ok_or_else(|| {
            "write classes from 0 to 8, like 0-4,7, or their names, like motorway,trunk".to_owned()
        })
    }

    /// The classes, ascending. Names are values of `highway` in the table, if it is known, or names
    /// in the [labels](crate::class_labels) of the classes.
    ///
    /// # Errors
    /// When no class has a name.
    pub fn classes(
        &self,
        table: Option<&FrcTable>,
        labels: &[String; FunctionalRoadClass::COUNT],
    ) -> Result<Vec<FunctionalRoadClass>, UnknownClass> {
        let mut classes = Vec::new();
        for entry in &self.0 {
            let (first, last) = match entry {
                &ClassEntry::Range(first, last) => (first, last),
                ClassEntry::Name(name) => {
                    let called = name.replace('_', " ");
                    let has_name = |label: &String| label.split(", ").any(|own| own == called);
                    let of_label = || labels.iter().position(has_name).map(|number| number as u8);
                    let mut values = table.into_iter().flat_map(FrcTable::values);
                    let of_table = values.find(|(value, _)| *value == name).and_then(|of| of.1);
                    let number = of_table.map(FunctionalRoadClass::number).or_else(of_label);
                    let number = number.ok_or_else(|| UnknownClass {
                        name: name.clone(),
                        labels: labels.to_vec(),
                    })?;
                    (number, number)
                }
            };
            classes.extend((first..=last).filter_map(FunctionalRoadClass::new));
        }
        classes.sort_unstable();
        classes.dedup();
        Ok(classes)
    }
}

impl<'de> Deserialize<'de> for Classes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum WrittenClass {
            Number(u8),
            Text(String),
        }
        #[derive(Deserialize)]
        #[serde(
            untagged,
            expecting = "expected a list of classes like [0, 1, \"primary\"], or a text like \"0-8\""
        )]
        enum WrittenClasses {
            List(Vec<WrittenClass>),
            Text(String),
        }
        let text = match WrittenClasses::deserialize(deserializer)? {
            WrittenClasses::List(list) => {
                let texts = list.into_iter().map(|class| match class {
                    WrittenClass::Number(number) => number.to_string(),
                    WrittenClass::Text(text) => text,
                });
                texts.collect::<Vec<_>>().join(",")
            }
            WrittenClasses::Text(text) => text,
        };
        Self::parse(&text).map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
#[path = "classes_tests.rs"]
mod tests;
