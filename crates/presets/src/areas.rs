//! The built-in tables of area classes, and the parser of area tables.

use corniche_areas::{AreaClass, AreaTable};
use corniche_config::AREA_TABLES;
use serde::Deserialize;

use crate::{PresetError, error::bounded};

/// An area table as TOML.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct AreaFile {
    name: String,
    #[serde(default)]
    sea: bool,
    area: Vec<AreaEntry>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct AreaEntry {
    class: String,
    tags: Vec<String>,
}

/// Names of the built-in area tables.
pub fn area_preset_names() -> impl Iterator<Item = &'static str> {
    AREA_TABLES.iter().map(|(name, _)| *name)
}

/// The text of the built-in table with this name, for [`parse_area_table`].
#[must_use]
pub fn area_preset(name: &str) -> Option<&'static str> {
    AREA_TABLES.iter().find(|(preset, _)| *preset == name).map(|(_, text)| *text)
}

/// Parses an area table.
///
/// # Errors
/// When the text is not TOML, names an unknown class, or its entries do not form a table.
pub fn parse_area_table(text: &str) -> Result<AreaTable, PresetError> {
    let file: AreaFile = toml::from_str(bounded(text)?)?;
    let mut tags = Vec::new();
    for AreaEntry { class, tags: of_class } in file.area {
        let Some(class) = AreaClass::from_name(&class) else {
            return Err(PresetError::AreaClass { class });
        };
        tags.extend(of_class.into_iter().map(|tag| (tag, class)));
    }
    Ok(AreaTable::new(file.name, tags)?.with_sea(file.sea))
}
