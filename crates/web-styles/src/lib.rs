//! Own styles of a page: the text of a style, checked, as bytes for the module of the map (`corniche-web`).
//!
//! ```text
//!  my-style.toml ──► style_table ──► bytes ──► corniche-web: MapView::keep_style
//! ```
//!
//! This is a module of its own because the reader of TOML weighs more than a tenth of the map's module. A page fetches it with its
//! first own style, and never without one.
//!
//! This crate never fetches a file, never draws, and knows no map.

use corniche_styles::{Style, StyleError, parse_style};

/// A table with one style, as the build script of `corniche-web` writes that of the styles that come with the program.
///
/// # Errors
/// In the words of [`parse_style`], when the text is no style.
#[cfg_attr(target_arch = "wasm32", wasm_bindgen::prelude::wasm_bindgen)]
pub fn style_table(name: &str, text: &str) -> Result<Vec<u8>, String> {
    let style = parse_style(text).map_err(|error: StyleError| error.to_string())?;
    let table: [(&str, Style); 1] = [(name, style)];
    // A list of known length, as the other side reads it.
    bincode::serde::encode_to_vec(table.as_slice(), bincode::config::legacy())
        .map_err(|error| error.to_string())
}

#[cfg(test)]
#[path = "lib_tests.rs"]
mod tests;
