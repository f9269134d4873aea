//! Attributes that a layer keeps of its objects.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::TagUnit;

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
}
