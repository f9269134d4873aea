//! The built-in styles, read from their TOML files.

use corniche_config::STYLES;

/// Names of the built-in styles, the default one first.
pub fn style_preset_names() -> impl Iterator<Item = &'static str> {
    STYLES.iter().map(|(name, _)| *name)
}

/// Returns the text of the built-in style of this name, for [`parse_style`](crate::parse_style).
#[must_use]
pub fn style_preset(name: &str) -> Option<&'static str> {
    STYLES.iter().find(|(preset, _)| *preset == name).map(|(_, text)| *text)
}

#[cfg(test)]
#[expect(clippy::unreadable_literal, reason = "figures as they were published")]
#[path = "legible_tests.rs"]
mod tests;
