//! The built-in tables of functional road classes (FRC), and the parser of FRC tables.

use std::collections::BTreeMap;

use corniche_config::FRC_TABLES;
use corniche_roads::FrcTable;
use serde::Deserialize;

use crate::{PresetError, error::bounded};

/// An FRC table as TOML.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct FrcFile {
    name: String,
    least_class: u8,
    classes: BTreeMap<String, u8>,
    #[serde(default)]
    not_roads: Vec<String>,
}

/// Names of the built-in FRC tables.
pub fn frc_preset_names() -> impl Iterator<Item = &'static str> {
    FRC_TABLES.iter().map(|(name, _)| *name)
}

/// The text of the built-in table with this name, for [`parse_frc_table`].
#[must_use]
pub fn frc_preset(name: &str) -> Option<&'static str> {
    FRC_TABLES.iter().find(|(preset, _)| *preset == name).map(|(_, text)| *text)
}

/// Parses an FRC table.
///
/// # Errors
/// When the text is not TOML, or its entries do not form a table.
pub fn parse_frc_table(text: &str) -> Result<FrcTable, PresetError> {
    let file: FrcFile = toml::from_str(bounded(text)?)?;
    let classes = file.classes.into_iter().collect();
    Ok(FrcTable::new(file.name, classes, file.not_roads, file.least_class)?)
}
