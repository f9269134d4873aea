//! Attributes that a layer keeps of its objects: what tables ask for, and the values of an object.

use corniche_roads::{is_yes, tag};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    TagUnit,
    titles::{is_language_tag, is_plain_text},
};

/// What a layer keeps of a tag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AttributeKind {
    /// The value as it is tagged.
    Text,
    /// Names by language: the tag itself (`name`), and all tags that append a language to it
    /// (`name:de`).
    Names,
    /// Yes or no, in the spellings that OSM's data consumers accept.
    YesNo,
    /// A number in this unit; values that are not numbers are counted.
    Number(TagUnit),
    /// A number that follows from all objects of the layer, whatever the tag of this key is.
    Derived(DerivedNumber),
}

/// A number that follows from all objects of a layer in the extract, also from those outside the
/// built region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DerivedNumber {
    /// For points: the distance in whole metres to the nearest point of the layer with a larger
    /// number `ele`, along a great circle of a sphere with a radius of 6 371 008.8 m. Of two points
    /// with one `ele`, the one with the smaller id counts as higher. The highest has half the
    /// circumference. Points without `ele` have no distance.
    Isolation,
}

impl DerivedNumber {
    /// The attribute that has the heights of points.
    pub const HEIGHT_KEY: &'static str = "ele";
}

/// The value of an attribute of an object.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum AttributeValue {
    /// A text.
    Text(String),
    /// Names: language and name, the name without a language first (`""`), then by language.
    Names(Vec<(String, String)>),
    /// Yes or no.
    YesNo(bool),
    /// A number, in the unit of the attribute.
    Number(f64),
}

/// The largest number of names of an object.
pub const MAX_NAMES: usize = 256;
/// OSM's limit on the length of values, characters.
pub(crate) const MAX_TAG_CHARS: usize = 255;

impl AttributeKind {
    /// Reads the value of an object with these `(key, value)` tags; `None` without a value. If a
    /// key occurs twice, the first value counts. Calls `on_unread` for each value that is not of
    /// this kind, and for texts that are too long or contain characters that are invisible or
    /// change the direction of writing: they have no value.
    pub(crate) fn read(
        self,
        key: &str,
        tags: &[(&str, &str)],
        mut on_unread: impl FnMut(),
    ) -> Option<AttributeValue> {
        let tagged = tag(tags, key);
        let mut text = |value: &str| {
            let value = value.trim();
            if is_plain_text(value, MAX_TAG_CHARS) {
                return Some(value.to_owned());
            }
            if !value.is_empty() {
                on_unread();
            }
            None
        };
        let value = match self {
            Self::Text => return text(tagged?).map(AttributeValue::Text),
            Self::Names => {
                let mut names: Vec<(String, String)> = Vec::new();
                for (own, value) in tags {
                    let language = own.strip_prefix(key).and_then(|rest| match rest {
                        "" => Some(rest),
                        // Longer words are other suffixes, such as that of `name:left`.
                        _ => rest.strip_prefix(':').filter(|rest| is_language_tag(rest, 3)),
                    });
                    let Some(language) = language else { continue };
                    if let Some(name) = text(value) {
                        names.push((language.to_owned(), name));
                    }
                }
                names.sort_by(|(one, _), (other, _)| one.cmp(other));
                names.dedup_by(|(later, _), (first, _)| later == first);
                names.truncate(MAX_NAMES);
                return (!names.is_empty()).then_some(AttributeValue::Names(names));
            }
            Self::YesNo => match tagged? {
                "no" | "false" | "0" => Some(false),
                value => is_yes(value).then_some(true),
            }
            .map(AttributeValue::YesNo),
            Self::Number(unit) => unit.number(tagged?).map(AttributeValue::Number),
            Self::Derived(_) => return None,
        };
        if value.is_none() {
            on_unread();
        }
        value
    }
}

impl AttributeValue {
    /// Whether the value is of this kind, and can be stored.
    #[must_use]
    pub fn is_of(&self, kind: AttributeKind) -> bool {
        match (self, kind) {
            (Self::Text(_), AttributeKind::Text) | (Self::YesNo(_), AttributeKind::YesNo) => true,
            (Self::Names(names), AttributeKind::Names) => {
                (1..=MAX_NAMES).contains(&names.len()) && names.is_sorted_by(|a, b| a.0 < b.0)
            }
            (Self::Number(number), AttributeKind::Number(_) | AttributeKind::Derived(_)) => {
                number.is_finite()
            }
            _ => false,
        }
    }

    /// Returns the value as one text; of names, the one in the first of these languages that the
    /// object has, else the one without a language, else the first.
    #[must_use]
    pub fn text(&self, languages: &[&str]) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::YesNo(yes) => if *yes { "yes" } else { "no" }.to_owned(),
            Self::Number(number) => number.to_string(),
            Self::Names(names) => {
                let in_language =
                    |wanted: &&str| names.iter().find(|(language, _)| language == wanted);
                let name = languages.iter().find_map(in_language).or_else(|| names.first());
                name.map(|(_, name)| name.clone()).unwrap_or_default()
            }
        }
    }
}

#[cfg(test)]
#[path = "layer_attribute_tests.rs"]
mod tests;
