//! Custom styles of a page: checks the text of a style and encodes it for the module of the map
//! (`corniche-web`).
//!
//! ```text
//!  my-style.toml ──► style_table ──► bytes ──► corniche-web: MapView::keep_style
//! ```
//!
//! This is a separate module because the TOML parser takes more than a tenth of the size of the
//! map's module. A page fetches it with its first custom style, and never otherwise.
//!
//! This crate never fetches a file, never draws, and knows no map.

use corniche_styles::{Style, StyleError, parse_style};

/// Returns a table with one style, in the format in which the build script of `corniche-web` writes
/// the bundled styles.
///
/// # Errors
/// The message of [`parse_style`], when the text is not a style.
#[cfg_attr(target_arch = "wasm32", wasm_bindgen::prelude::wasm_bindgen)]
pub fn style_table(name: &str, text: &str) -> Result<Vec<u8>, String> {
    let style = parse_style(text).map_err(|error: StyleError| error.to_string())?;
    let table: [(&str, Style); 1] = [(name, style)];
    // The list has a fixed length, like the list that the map's module reads.
    bincode::serde::encode_to_vec(table.as_slice(), bincode::config::legacy())
        .map_err(|error| error.to_string())
}

#[cfg(test)]
#[path = "lib_tests.rs"]
mod tests;
