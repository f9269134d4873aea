//! A condition on the value of one tag.

use std::{borrow::Cow, fmt};

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{
        self, MapAccess, SeqAccess, Visitor,
        value::{MapAccessDeserializer, SeqAccessDeserializer},
    },
};

use crate::TagUnit;

/// A condition on the value of one tag. In a table: a value, a list of values, `true` (any value),
/// `false` (no such tag), `{ not = … }`, `{ except = … }`, or `{ min = …, below = …, unit = … }`.
#[derive(Debug, Clone, PartialEq)]
pub enum TagCondition {
    /// The object has the tag, with any value.
    Present,
    /// The object does not have the tag.
    Absent,
    /// The value is one of these.
    OneOf(Vec<String>),
    /// The value is none of these, or the object does not have the tag.
    NoneOf(Vec<String>),
    /// The object has the tag, and the value is none of these.
    OtherThan(Vec<String>),
    /// The value is a number in this range.
    Range {
        /// The smallest number.
        min: Option<f64>,
        /// The number that all others are less than.
        below: Option<f64>,
        /// The unit of both, and of values without a unit.
        unit: TagUnit,
    },
}

impl TagCondition {
    /// Whether an object with this value of the tag (`None`: it does not have the tag) fulfils the
    /// condition.
    #[must_use]
    pub fn is_met(&self, value: Option<&str>) -> bool {
        let lists = |values: &[String], value: &str| values.iter().any(|one| one == value);
        match (self, value) {
            (Self::Absent | Self::NoneOf(_), None) | (Self::Present, Some(_)) => true,
            (_, None) | (Self::Absent, Some(_)) => false,
            (Self::OneOf(values), Some(value)) => lists(values, value),
            (Self::NoneOf(values) | Self::OtherThan(values), Some(value)) => !lists(values, value),
            (&Self::Range { min, below, unit }, Some(value)) => {
                unit.number(value).is_some_and(|number| is_between(min, below, number))
            }
        }
    }

    /// Whether only objects with the tag can fulfil the condition.
    #[must_use]
    pub fn needs_tag(&self) -> bool {
        !matches!(self, Self::Absent | Self::NoneOf(_))
    }

    /// The values that the condition names.
    #[must_use]
    pub fn values(&self) -> &[String] {
        match self {
            Self::OneOf(values) | Self::NoneOf(values) | Self::OtherThan(values) => values,
            Self::Present | Self::Absent | Self::Range { .. } => &[],
        }
    }
}

/// Whether a number is at least `min` and less than `below`.
pub(crate) fn is_between(min: Option<f64>, below: Option<f64>, number: f64) -> bool {
    min.is_none_or(|min| number >= min) && below.is_none_or(|below| number < below)
}

/// A condition as it is written.
#[derive(Serialize, JsonSchema)]
#[serde(untagged)]
enum ConditionForm<'a> {
    /// `true`: the tag with any value. `false`: no such tag.
    Flag(bool),
    /// One value, or one of several.
    Values(ValuesForm<'a>),
    /// Other values, or a number in a range.
    Table(TableForm<'a>),
}

/// A value, or a list of values.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a value or a list of values")]
enum ValuesForm<'a> {
    One(Cow<'a, str>),
    Many(Cow<'a, [String]>),
}

/// One of the keys `not` and `except`, or `min` and `below` with a unit.
#[derive(Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct TableForm<'a> {
    /// No tag with one of these values; no tag at all is also accepted.
    #[serde(skip_serializing_if = "Option::is_none")]
    not: Option<ValuesForm<'a>>,
    /// The tag with a value that is none of these.
    #[serde(skip_serializing_if = "Option::is_none")]
    except: Option<ValuesForm<'a>>,
    /// The smallest number.
    #[serde(skip_serializing_if = "Option::is_none")]
    min: Option<f64>,
    /// The number that all others are less than.
    #[serde(skip_serializing_if = "Option::is_none")]
    below: Option<f64>,
    /// The unit of both numbers, and of values without a unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<TagUnit>,
}

impl<'a> ValuesForm<'a> {
    fn new(values: &'a [String]) -> Self {
        match values {
            [one] => Self::One(Cow::Borrowed(one)),
            many => Self::Many(Cow::Borrowed(many)),
        }
    }

    fn into_values(self) -> Vec<String> {
        match self {
            Self::One(value) => vec![value.into_owned()],
            Self::Many(values) => values.into_owned(),
        }
    }
}

impl TableForm<'_> {
    fn condition<E: de::Error>(self) -> Result<TagCondition, E> {
        let Self { not, except, min, below, unit } = self;
        let is_range = min.is_some() || below.is_some() || unit.is_some();
        match (not, except, is_range) {
            (Some(not), None, false) => Ok(TagCondition::NoneOf(not.into_values())),
            (None, Some(except), false) => Ok(TagCondition::OtherThan(except.into_values())),
            (None, None, true) => {
                Ok(TagCondition::Range { min, below, unit: unit.unwrap_or_default() })
            }
            _ => Err(E::custom("expected one of `not`, `except`, or `min` and `below`")),
        }
    }
}

impl Serialize for TagCondition {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let table = TableForm::default();
        let form = match self {
            Self::Present => ConditionForm::Flag(true),
            Self::Absent => ConditionForm::Flag(false),
            Self::OneOf(values) => ConditionForm::Values(ValuesForm::new(values)),
            Self::NoneOf(values) => {
                ConditionForm::Table(TableForm { not: Some(ValuesForm::new(values)), ..table })
            }
            Self::OtherThan(values) => {
                ConditionForm::Table(TableForm { except: Some(ValuesForm::new(values)), ..table })
            }
            &Self::Range { min, below, unit } => {
                let unit = (unit != TagUnit::Count).then_some(unit);
                ConditionForm::Table(TableForm { min, below, unit, ..table })
            }
        };
        form.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for TagCondition {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ConditionVisitor)
    }
}

/// Reads a condition by the type of its value, so that an error within it keeps its place.
struct ConditionVisitor;

impl<'de> Visitor<'de> for ConditionVisitor {
    type Value = TagCondition;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value, a list of values, true, false, or a table with `not`, `except`, or `min` and `below`")
    }

    fn visit_bool<E: de::Error>(self, is_present: bool) -> Result<TagCondition, E> {
        Ok(if is_present { TagCondition::Present } else { TagCondition::Absent })
    }

    fn visit_str<E: de::Error>(self, value: &str) -> Result<TagCondition, E> {
        Ok(TagCondition::OneOf(vec![value.to_owned()]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, values: A) -> Result<TagCondition, A::Error> {
        Deserialize::deserialize(SeqAccessDeserializer::new(values)).map(TagCondition::OneOf)
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<TagCondition, A::Error> {
        TableForm::deserialize(MapAccessDeserializer::new(table))?.condition()
    }
}

impl JsonSchema for TagCondition {
    fn schema_name() -> Cow<'static, str> {
        "TagCondition".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        ConditionForm::json_schema(generator)
    }
}
