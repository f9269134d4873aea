//! Lists of functional road classes, as text and as a setting.

use corniche_roads::FunctionalRoadClass;
use serde::{Deserialize, Deserializer};

/// Class numbers, ascending and unique; at least one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Classes(Vec<u8>);

impl Classes {
    /// Parses numbers and ranges, such as `0-7`, `0,1,2` or `0-2,5`.
    ///
    /// # Errors
    /// When it is not such a list, or has a number above 8.
    pub fn parse(text: &str) -> Result<Self, String> {
        let range = |part: &str| -> Option<(u8, u8)> {
            let (first, last) = part.split_once('-').unwrap_or((part, part));
            Some((first.trim().parse().ok()?, last.trim().parse().ok()?))
        };
        let mut numbers = Vec::new();
        for part in text.split(',') {
            match range(part) {
                Some((first, last)) if first <= last && is_class(last) => {
                    numbers.extend(first..=last);
                }
                _ => return Err("write classes from 0 to 8, like 0-7 or 0,1,2".to_owned()),
            }
        }
        numbers.sort_unstable();
        numbers.dedup();
        Ok(Self(numbers))
    }

    /// The numbers.
    #[must_use]
    pub fn numbers(&self) -> &[u8] {
        &self.0
    }

    /// The classes of these numbers.
    #[must_use]
    pub fn classes(&self) -> Vec<FunctionalRoadClass> {
        self.0.iter().copied().filter_map(FunctionalRoadClass::new).collect()
    }
}

fn is_class(number: u8) -> bool {
    FunctionalRoadClass::new(number).is_some()
}

impl<'de> Deserialize<'de> for Classes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(
            untagged,
            expecting = "expected a list of classes like [0, 1, 2], or a text like \"0-8\""
        )]
        enum WrittenClasses {
            Numbers(Vec<u8>),
            Text(String),
        }
        let text = match WrittenClasses::deserialize(deserializer)? {
            WrittenClasses::Numbers(numbers) => {
                numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
            }
            WrittenClasses::Text(text) => text,
        };
        Self::parse(&text).map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
#[path = "classes_tests.rs"]
mod tests;
