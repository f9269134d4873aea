//! What commands print as JSON, as types: the schemas under `docs/schema` are made from them.
//!
//! Programs rely on these: fields may be added, but not changed. Positions, rectangles and ranges are lists of numbers; everything else
//! that belongs together is an object.

pub(crate) mod areas;
pub(crate) mod boundaries;
pub(crate) mod growth;
pub(crate) mod info;
pub(crate) mod plan;
pub(crate) mod progress;
pub(crate) mod tile;
pub(crate) mod verify;

use serde::Serialize;

use crate::escaped::in_json;

/// As one line.
pub(crate) fn to_line(document: &impl Serialize) -> String {
    // Texts, numbers, lists and fields have a JSON form, so there is no error.
    let document = serde_json::to_string(document).unwrap_or_default();
    in_json(&document).into_owned()
}

#[cfg(test)]
#[path = "documents/schema_tests.rs"]
mod schema_tests;
