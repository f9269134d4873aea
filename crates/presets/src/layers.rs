//! The built-in layers, and the parser of layer tables.

use corniche_config::LAYERS;
use corniche_layers::{LayerForm, LayerTable, TablePath, TableStep};
use toml::de::{DeTable, DeValue};

use crate::{PresetError, error::bounded};

/// Whether these names of layers are the single word that turns all layers off. A file of this name
/// is `./none`.
#[must_use]
pub fn is_no_layers(names: &[String]) -> bool {
    names == ["none"]
}

/// Names of the built-in layers.
pub fn layer_preset_names() -> impl Iterator<Item = &'static str> {
    LAYERS.iter().map(|(name, _)| *name)
}

/// The text of the built-in layer with this name, for [`parse_layer_table`].
#[must_use]
pub fn layer_preset(name: &str) -> Option<&'static str> {
    LAYERS.iter().find(|(preset, _)| *preset == name).map(|(_, text)| *text)
}

/// Parses a layer table.
///
/// # Errors
/// When the text is not TOML, has a key that layers do not have, or does not form a layer, or
/// a class can never be reached. Errors name the line and the key.
pub fn parse_layer_table(text: &str) -> Result<LayerTable, PresetError> {
    let form: LayerForm = toml::from_str(bounded(text)?)?;
    let table = LayerTable::new(form).and_then(|table| table.check_reach().map(|()| table));
    table.map_err(|error| PresetError::Layer { line: line_of(text, &error.path), error })
}

/// Returns the line of a value, counted from 1. If the value is not in the text, because it is
/// missing, this is the line of what it would be in.
fn line_of(text: &str, path: &TablePath) -> usize {
    let Ok(document) = DeTable::parse(text) else { return 1 };
    let mut value = &DeValue::Table(document.get_ref().clone());
    let mut start = 0;
    for step in &path.0 {
        let next = match (value, step) {
            (DeValue::Table(table), TableStep::Key(key)) => {
                let entry = table.iter().find(|(own, _)| own.get_ref() == key);
                entry.map(|(own, value)| (own.span().start, value.get_ref()))
            }
            (DeValue::Array(array), &TableStep::Index(index)) => {
                array.get(index).map(|value| (value.span().start, value.get_ref()))
            }
            _ => None,
        };
        let Some(next) = next else { break };
        (start, value) = next;
    }
    1 + text[..start].matches('\n').count()
}
