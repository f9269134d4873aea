//! The types of all JSON that commands print; the schemas under `docs/schema` are generated
//! from them.
//!
//! Programs rely on these types: fields may be added, but not changed. Positions, rectangles
//! and ranges are lists of numbers; other groups of values are objects.

pub(crate) mod growth;
pub(crate) mod info;
pub(crate) mod layers;
pub(crate) mod plan;
pub(crate) mod profile;
pub(crate) mod progress;
pub(crate) mod spans;
pub(crate) mod tile;
pub(crate) mod verify;

use std::io::{self, Write};

use serde::Serialize;

use crate::escaped::JsonTexts;

/// Serializes a document as one line.
pub(crate) fn to_line(document: &impl Serialize) -> String {
    let mut line = Vec::new();
    // Texts, numbers, lists and fields always have a JSON form, so serialization cannot fail.
    let _ = write_line_to(&mut line, document);
    String::from_utf8(line).unwrap_or_default()
}

/// Writes a document as one line during serialization: the whole text is never in memory.
///
/// # Errors
/// When writing fails.
pub(crate) fn write_line_to(out: impl Write, document: &impl Serialize) -> io::Result<()> {
    let mut serializer = serde_json::Serializer::with_formatter(out, JsonTexts);
    document.serialize(&mut serializer).map_err(io::Error::from)
}

#[cfg(test)]
#[path = "documents/info_schema_tests.rs"]
mod info_schema;
#[cfg(test)]
#[path = "documents/record_schemas_tests.rs"]
mod record_schemas;
#[cfg(test)]
#[path = "documents/schema_tests.rs"]
mod schema_tests;
#[cfg(test)]
#[path = "documents/settings_schema_tests.rs"]
mod settings_schema_tests;
