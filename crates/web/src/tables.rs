//! The bundled styles and labels, as the build script has read them, and the custom styles of the
//! page.

use std::cell::RefCell;

use corniche_roads::FunctionalRoadClass;
use corniche_styles::Style;
use serde::de::DeserializeOwned;

const STYLES: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/styles.bin"));
const LABELS: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/labels.bin"));

thread_local! {
    /// Custom styles, by their addresses, for all maps of the page.
    static OWN: RefCell<Vec<(String, Style)>> = RefCell::default();
}

/// Reads a table of named values from the build script.
fn table<T: DeserializeOwned>(bytes: &[u8]) -> Vec<(String, T)> {
    let read = bincode::serde::decode_from_slice(bytes, bincode::config::legacy());
    read.map(|(table, _)| table).unwrap_or_default()
}

/// The names of the styles, the default one first.
pub(crate) fn style_names() -> Vec<String> {
    table::<Style>(STYLES).into_iter().map(|(name, _)| name).collect()
}

/// The style of this name, bundled or custom.
///
/// # Errors
/// When there is no such style, as a message.
pub(crate) fn style(name: &str) -> Result<Style, String> {
    let own = OWN.with_borrow(Clone::clone);
    let found = table(STYLES).into_iter().chain(own).find(|(known, _)| known == name);
    found.map(|(_, style)| style).ok_or_else(|| {
        let names = style_names().join(", ");
        format!("there is no style {name:?}; there are {names}")
    })
}

/// Stores the styles of a table from `corniche-web-styles`; they replace styles of the same names.
///
/// # Errors
/// When the bytes are not such a table, as a message.
pub(crate) fn keep(styles: &[u8]) -> Result<(), String> {
    let styles = table::<Style>(styles);
    if styles.is_empty() {
        return Err("the files of corniche-map are of different versions".to_owned());
    }
    OWN.with_borrow_mut(|own| {
        own.retain(|(name, _)| !styles.iter().any(|(new, _)| new == name));
        own.extend(styles);
    });
    Ok(())
}

/// The names of the classes, class 0 first, with the FRC table of this name.
pub(crate) fn class_labels(frc_table: &str) -> [String; FunctionalRoadClass::COUNT] {
    let known = table::<Vec<String>>(LABELS).into_iter().find(|(name, _)| name == frc_table);
    let known = known.and_then(|(_, labels)| labels.try_into().ok());
    known.unwrap_or_else(|| std::array::from_fn(|class| format!("class {class}")))
}

#[cfg(test)]
#[path = "tables_tests.rs"]
mod tests;
