//! Which tags an object of a class has.

use std::{collections::BTreeMap, fmt};

use corniche_roads::tag;
use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize,
    de::{
        MapAccess, SeqAccess, Visitor,
        value::{MapAccessDeserializer, SeqAccessDeserializer},
    },
};

use crate::TagCondition;

/// The tags of a class: an object belongs to it that fulfils all conditions of one alternative. In
/// a table: conditions by key, or a list of such tables.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum TagRule {
    /// All of these conditions.
    AllOf(BTreeMap<String, TagCondition>),
    /// All conditions of one of these.
    AnyOf(Vec<BTreeMap<String, TagCondition>>),
}

impl Default for TagRule {
    fn default() -> Self {
        Self::AnyOf(Vec::new())
    }
}

impl TagRule {
    /// Returns the alternatives.
    #[must_use]
    pub fn alternatives(&self) -> &[BTreeMap<String, TagCondition>] {
        match self {
            Self::AllOf(conditions) => std::slice::from_ref(conditions),
            Self::AnyOf(alternatives) => alternatives,
        }
    }

    /// Whether an object with these `(key, value)` tags fulfils the rule. If a key occurs twice,
    /// the first value counts.
    #[must_use]
    pub fn is_met(&self, tags: &[(&str, &str)]) -> bool {
        self.alternatives().iter().any(|conditions| {
            conditions.iter().all(|(key, condition)| condition.is_met(tag(tags, key)))
        })
    }
}

impl<'de> Deserialize<'de> for TagRule {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(RuleVisitor)
    }
}

/// Reads a rule by the type of its value, so that an error within it keeps its place.
struct RuleVisitor;

impl<'de> Visitor<'de> for RuleVisitor {
    type Value = TagRule;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table of conditions by key, or a list of such tables")
    }

    fn visit_map<A: MapAccess<'de>>(self, conditions: A) -> Result<TagRule, A::Error> {
        Deserialize::deserialize(MapAccessDeserializer::new(conditions)).map(TagRule::AllOf)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, alternatives: A) -> Result<TagRule, A::Error> {
        Deserialize::deserialize(SeqAccessDeserializer::new(alternatives)).map(TagRule::AnyOf)
    }
}
