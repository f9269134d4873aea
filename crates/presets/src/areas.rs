//! The tables of area classes that come with the program, and the reading of such tables.

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

/// Names of the area tables that come with the program.
pub fn area_preset_names() -> impl Iterator<Item = &'static str> {
    AREA_TABLES.iter().map(|(name, _)| *name)
}

/// The text of the table of this name that comes with the program, for [`parse_area_table`].
#[must_use]
pub fn area_preset(name: &str) -> Option<&'static str> {
    AREA_TABLES.iter().find(|(preset, _)| *preset == name).map(|(_, text)| *text)
}

/// Reads an area table's text.
///
/// # Errors
/// When it is no TOML, names a class that does not exist, or its entries make no table.
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
