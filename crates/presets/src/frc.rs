//! The tables of functional road classes that come with the program, and the reading of such tables.

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

/// Names of the FRC tables that come with the program.
pub fn frc_preset_names() -> impl Iterator<Item = &'static str> {
    FRC_TABLES.iter().map(|(name, _)| *name)
}

/// The text of the table of this name that comes with the program, for [`parse_frc_table`].
#[must_use]
pub fn frc_preset(name: &str) -> Option<&'static str> {
    FRC_TABLES.iter().find(|(preset, _)| *preset == name).map(|(_, text)| *text)
}

/// Reads an FRC table's text.
///
/// # Errors
/// When it is no TOML, or its entries make no table.
pub fn parse_frc_table(text: &str) -> Result<FrcTable, PresetError> {
    let file: FrcFile = toml::from_str(bounded(text)?)?;
    let classes = file.classes.into_iter().collect();
    Ok(FrcTable::new(file.name, classes, file.not_roads, file.least_class)?)
}
