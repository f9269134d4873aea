//! A table that assigns a functional road class (FRC) to each value of `highway`; it is validated
//! when it is created.

use std::{collections::BTreeMap, fmt::Write as _};

use crate::FunctionalRoadClass;

/// The functional road class (FRC) of each `highway` value. A table is validated when it is
/// created.
///
/// A table lists every value it knows, including values that are *not* roads. A value that it does
/// not list is [`Classified::Unknown`] and never guessed. The only rule beyond the list: `X_link`
/// has the class of `X` unless it is listed itself.
///
/// Source of the classes: OpenLR White Paper v1.5 (names 0–7). No standard assigns OSM values to
/// them, hence tables.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrcTable {
    name: String,
    /// The class of each value; `None` for a known value that is not a road.
    values: BTreeMap<String, Option<FunctionalRoadClass>>,
    least_class: FunctionalRoadClass,
    /// The classes that are on, if they differ from what `least_class` says.
    chosen: Option<[bool; FunctionalRoadClass::COUNT]>,
    /// Whether packages record the labels of the classes.
    tells_labels: bool,
}

/// The reason why entries do not form an [`FrcTable`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum FrcTableError {
    #[error(
        "the name of an FRC table must have 1 to 64 characters from a-z, A-Z, 0-9, '.', '-' and '_', got {name:?}"
    )]
    Name { name: String },
    #[error("FRC table {name:?} lists no highway value with a class")]
    NoClasses { name: String },
    #[error("FRC table {name:?} gives highway={value} class {class}; classes are 0 to 8")]
    Class { name: String, value: String, class: u8 },
    #[error("FRC table {name:?} has least class {class}; classes are 0 to 8")]
    LeastClass { name: String, class: u8 },
    #[error("no class is chosen, or a chosen class does not exist; classes are 0 to 8")]
    Choice,
    #[error("FRC table {name:?} lists highway={value} twice; keep one of the entries")]
    Twice { name: String, value: String },
    #[error(
        "FRC table {name:?} lists {value:?}, which is not a highway value: it is empty or contains spaces or control characters"
    )]
    Value { name: String, value: String },
}

/// The result of looking up the tags of a way in a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Classified<'t> {
    /// The way is a road of this class, and the class is on.
    Road(FunctionalRoadClass),
    /// The way is a road of this class, and the class is off.
    NotShown(FunctionalRoadClass),
    /// The way is not a road, and the table knows it.
    NotARoad(NotARoad),
    /// The table does not list this `highway` value.
    Unknown(&'t str),
}

/// The reason why a way is not a road.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum NotARoad {
    /// The way has no `highway` tag.
    NoHighway,
    /// The table lists the way's value as no road (`construction`, `platform`, …).
    Listed,
    /// The way has a known `highway` value and `area=yes`: it is the outline of a surface, not an
    /// axis.
    Area,
}

impl FrcTable {
    /// Creates the table `name`: `classes` assigns a class (0–8) to `highway` values, `not_roads`
    /// lists the values that are not roads, and classes above `least_class` are off.
    ///
    /// # Errors
    /// When the name is not valid in a package's metadata, a class is above 8, a value is listed
    /// twice or cannot be the value of a tag, or nothing has a class.
    pub fn new(
        name: impl Into<String>,
        classes: Vec<(String, u8)>,
        not_roads: Vec<String>,
        least_class: u8,
    ) -> Result<Self, FrcTableError> {
        let name = name.into();
        let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
        if name.is_empty() || name.len() > 64 || !name.chars().all(is_plain) {
            return Err(FrcTableError::Name { name });
        }
        if classes.is_empty() {
            return Err(FrcTableError::NoClasses { name });
        }
        let Some(least) = FunctionalRoadClass::new(least_class) else {
            return Err(FrcTableError::LeastClass { name, class: least_class });
        };
        let mut entries = Vec::with_capacity(classes.len() + not_roads.len());
        for (value, number) in classes {
            match FunctionalRoadClass::new(number) {
                Some(class) => entries.push((value, Some(class))),
                None => return Err(FrcTableError::Class { name, value, class: number }),
            }
        }
        entries.extend(not_roads.into_iter().map(|value| (value, None)));
        let mut values = BTreeMap::new();
        for (value, class) in entries {
            if value.is_empty() || value.chars().any(|c| c.is_whitespace() || c.is_control()) {
                return Err(FrcTableError::Value { name, value });
            }
            if values.contains_key(&value) {
                return Err(FrcTableError::Twice { name, value });
            }
            values.insert(value, class);
        }
        Ok(Self { name, values, least_class: least, chosen: None, tells_labels: false })
    }

    /// Returns the name of the table, as packages record it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the least important class that is on.
    #[must_use]
    pub fn least_class(&self) -> FunctionalRoadClass {
        let least = FunctionalRoadClass::all().rev().find(|&class| self.shows(class));
        least.unwrap_or(self.least_class)
    }

    /// Returns the least important class that the table itself turns on, without a choice of
    /// classes.
    #[must_use]
    pub const fn own_least_class(&self) -> FunctionalRoadClass {
        self.least_class
    }

    /// Whether a class is on.
    #[must_use]
    pub fn shows(&self, class: FunctionalRoadClass) -> bool {
        match &self.chosen {
            Some(chosen) => chosen[usize::from(class.number())],
            None => class <= self.least_class,
        }
    }

    /// Returns the same table with these classes on, and no others.
    ///
    /// # Errors
    /// When `classes` is empty, or contains a class above 8.
    pub fn with_classes(self, classes: &[u8]) -> Result<Self, FrcTableError> {
        let mut on = [false; FunctionalRoadClass::COUNT];
        for &class in classes {
            *on.get_mut(usize::from(class)).ok_or(FrcTableError::Choice)? = true;
        }
        if !on.contains(&true) {
            return Err(FrcTableError::Choice);
        }
        let plain = Self { chosen: None, ..self };
        let is_own = FunctionalRoadClass::all()
            .all(|class| plain.shows(class) == on[usize::from(class.number())]);
        Ok(Self { chosen: (!is_own).then_some(on), ..plain })
    }

    /// Returns the classes that are on, ascending, if they differ from those that the table itself
    /// turns on.
    #[must_use]
    pub fn chosen_classes(&self) -> Option<Vec<u8>> {
        self.chosen?;
        let on = FunctionalRoadClass::all().filter(|&class| self.shows(class));
        Some(on.map(FunctionalRoadClass::number).collect())
    }

    /// Returns the same table with another least class.
    #[must_use]
    pub fn with_least_class(self, least_class: FunctionalRoadClass) -> Self {
        Self { least_class, chosen: None, ..self }
    }

    /// Returns the same table, but packages record the labels of its classes, because their readers
    /// do not know the table by its name.
    #[must_use]
    pub fn with_recorded_labels(self) -> Self {
        Self { tells_labels: true, ..self }
    }

    /// Returns the labels of the classes that packages record.
    #[must_use]
    pub fn recorded_labels(&self) -> Option<[String; FunctionalRoadClass::COUNT]> {
        self.tells_labels.then(|| self.class_labels())
    }

    /// Returns all listed values with their class, ordered by value; `None` for values that are not
    /// roads.
    pub fn values(&self) -> impl Iterator<Item = (&str, Option<FunctionalRoadClass>)> {
        self.values.iter().map(|(value, &class)| (value.as_str(), class))
    }

    /// Returns the whole table as text, one entry per line, sorted. Equal tables give the same
    /// text, whatever their files look like, so this text is hashed.
    #[must_use]
    pub fn canonical_text(&self) -> String {
        let mut text = format!("name={}\nleast_class={}\n", self.name, self.least_class.number());
        if let Some(chosen) = self.chosen_classes() {
            let chosen: Vec<String> = chosen.iter().map(ToString::to_string).collect();
            let _ = writeln!(text, "classes={}", chosen.join(","));
        }
        for (value, class) in self.values() {
            // Writing to a String cannot fail.
            let _ = match class {
                Some(class) => writeln!(text, "{value}={}", class.number()),
                None => writeln!(text, "{value}=not a road"),
            };
        }
        text
    }

    /// Classifies a way with these `(key, value)` tags. If a key occurs twice, the first value
    /// counts.
    #[must_use]
    pub fn classify<'t>(&self, tags: &[(&'t str, &'t str)]) -> Classified<'t> {
        let Some(highway) = tag(tags, "highway") else {
            return Classified::NotARoad(NotARoad::NoHighway);
        };
        match self.entry(highway) {
            None => Classified::Unknown(highway),
            Some(None) => Classified::NotARoad(NotARoad::Listed),
            Some(Some(_)) if is_area(tags) => Classified::NotARoad(NotARoad::Area),
            Some(&Some(class)) if !self.shows(class) => Classified::NotShown(class),
            Some(&Some(class)) => Classified::Road(class),
        }
    }

    /// Returns the entry for this value, directly or by the link rule.
    fn entry(&self, highway: &str) -> Option<&Option<FunctionalRoadClass>> {
        let of_parent = || self.values.get(highway.strip_suffix("_link")?);
        // A link to a value that is not a road counts as unknown.
        self.values.get(highway).or_else(|| of_parent().filter(|class| class.is_some()))
    }
}

/// Whether a way is the outline of an area.
#[must_use]
pub fn is_area(tags: &[(&str, &str)]) -> bool {
    tag(tags, "area").is_some_and(is_yes)
}

/// Returns the value of the first tag with this key.
#[must_use]
pub fn tag<'t>(tags: &[(&'t str, &'t str)], key: &str) -> Option<&'t str> {
    tags.iter().find(|(k, _)| *k == key).map(|&(_, value)| value)
}

/// Whether a value is one of the three spellings of *yes* that data consumers accept (OSM wiki,
/// *Key:oneway*).
#[must_use]
pub fn is_yes(value: &str) -> bool {
    matches!(value, "yes" | "true" | "1")
}

#[cfg(test)]
#[path = "frc_table_tests.rs"]
mod tests;
