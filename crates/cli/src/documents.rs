//! What commands print as JSON, as types: the schemas under `docs/schema` are made from them.
//!
//! Programs rely on these: fields may be added, but not changed. Positions, rectangles and ranges are lists of numbers; everything else
//! that belongs together is an object.

pub(crate) mod areas;
pub(crate) mod growth;
pub(crate) mod info;
pub(crate) mod lines;
pub(crate) mod plan;
pub(crate) mod profile;
pub(crate) mod progress;
pub(crate) mod spans;
pub(crate) mod tile;
pub(crate) mod verify;

use std::io::{self, Write};

use serde::Serialize;

use crate::escaped::JsonTexts;

/// As one line.
pub(crate) fn to_line(document: &impl Serialize) -> String {
    let mut line = Vec::new();
    // Texts, numbers, lists and fields have a JSON form, so there is no error.
    let _ = write_line_to(&mut line, document);
    String::from_utf8(line).unwrap_or_default()
}

/// Writes a document as one line while it is made: its text is never held as a whole.
///
/// # Errors
/// When it cannot be written.
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
