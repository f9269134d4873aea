//! A table that assigns a class of area to tags; it is validated when it is created.

use std::{collections::BTreeMap, fmt::Write as _};

use crate::AreaClass;

/// The tags that make each class of area. A table is validated when it is created.
///
/// The first tag of an object that the table lists decides. Tags are checked in the order of the
/// table's keys, so that their order in a file does not matter. The sea has no tags: it is built
/// from coastlines, if the table includes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AreaTable {
    name: String,
    /// The class of each value, by key; keys are in the order in which they were first named.
    keys: Vec<(String, BTreeMap<String, AreaClass>)>,
    has_sea: bool,
}

/// The reason why entries do not form an [`AreaTable`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum AreaTableError {
    #[error(
        "the name of an area table must have 1 to 64 characters from a-z, A-Z, 0-9, '.', '-' and '_', got {name:?}"
    )]
    Name { name: String },
    #[error("area table {name:?} lists no tags")]
    NoTags { name: String },
    #[error("area table {name:?} lists {tag:?}, which is not of the form key=value")]
    Tag { name: String, tag: String },
    #[error("area table {name:?} lists {tag} twice; keep one of the entries")]
    Twice { name: String, tag: String },
    #[error(
        "area table {name:?} assigns tags to the class sea, which is built from coastlines; remove them"
    )]
    Sea { name: String },
}

impl AreaTable {
    /// Creates the table `name` from tags as `key=value`, each with its class. Keys that come first
    /// decide first.
    ///
    /// # Errors
    /// When the name is not valid in a package's metadata, a tag is invalid or is listed twice, or
    /// there are no tags.
    pub fn new(
        name: impl Into<String>,
        tags: Vec<(String, AreaClass)>,
    ) -> Result<Self, AreaTableError> {
        let name = name.into();
        let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
        if name.is_empty() || name.len() > 64 || !name.chars().all(is_plain) {
            return Err(AreaTableError::Name { name });
        }
        if tags.is_empty() {
            return Err(AreaTableError::NoTags { name });
        }
        let mut keys: Vec<(String, BTreeMap<String, AreaClass>)> = Vec::new();
        for (tag, class) in tags {
            if class == AreaClass::Sea {
                return Err(AreaTableError::Sea { name });
            }
            let is_text = |part: &str| {
                !part.is_empty() && !part.chars().any(|c| c.is_whitespace() || c.is_control())
            };
            let parts = tag.split_once('=').filter(|(key, value)| is_text(key) && is_text(value));
            let Some((key, value)) = parts else { return Err(AreaTableError::Tag { name, tag }) };
            let known = keys.iter().position(|(known, _)| known == key);
            let place = known.unwrap_or_else(|| {
                keys.push((key.to_owned(), BTreeMap::new()));
                keys.len() - 1
            });
            if keys[place].1.insert(value.to_owned(), class).is_some() {
                return Err(AreaTableError::Twice { name, tag });
            }
        }
        Ok(Self { name, keys, has_sea: false })
    }

    /// Returns the same table with or without the sea, which is built from coastlines.
    #[must_use]
    pub fn with_sea(self, has_sea: bool) -> Self {
        Self { has_sea, ..self }
    }

    /// Whether the table includes the sea.
    #[must_use]
    pub const fn has_sea(&self) -> bool {
        self.has_sea
    }

    /// Returns the name of the table, as packages record it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the class of an object with these `(key, value)` tags, or `None`. If a key occurs
    /// twice, the first value counts.
    #[must_use]
    pub fn classify(&self, tags: &[(&str, &str)]) -> Option<AreaClass> {
        let value_of = |key: &str| tags.iter().find(|(k, _)| *k == key).map(|&(_, value)| value);
        self.keys.iter().find_map(|(key, values)| values.get(value_of(key)?).copied())
    }

    /// Returns the keys, in the order in which they decide.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.keys.iter().map(|(key, _)| key.as_str())
    }

    /// Returns all tags with their class: keys in the order in which they decide, values in
    /// alphabetical order.
    pub fn tags(&self) -> impl Iterator<Item = (&str, &str, AreaClass)> {
        self.keys.iter().flat_map(|(key, values)| {
            values.iter().map(move |(value, &class)| (key.as_str(), value.as_str(), class))
        })
    }

    /// Returns the whole table as text, one tag per line. Equal tables give the same text, whatever
    /// their files look like, so this text is hashed.
    #[must_use]
    pub fn canonical_text(&self) -> String {
        let mut text = format!("name={}\n", self.name);
        if self.has_sea {
            text.push_str("sea\n");
        }
        for (key, value, class) in self.tags() {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{key}={value}: {class}");
        }
        text
    }
}

#[cfg(test)]
#[path = "area_table_tests.rs"]
mod tests;
