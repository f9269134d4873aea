//! The styles that come with the program.

use corniche_config::STYLES;

/// Names of the styles that come with the program, the default one first.
pub fn style_preset_names() -> impl Iterator<Item = &'static str> {
    STYLES.iter().map(|(name, _)| *name)
}

/// The text of the style of this name that comes with the program, for [`parse_style`](crate::parse_style).
#[must_use]
pub fn style_preset(name: &str) -> Option<&'static str> {
    STYLES.iter().find(|(preset, _)| *preset == name).map(|(_, text)| *text)
}

#[cfg(test)]
#[expect(clippy::unreadable_literal, reason = "figures as they were published")]
#[path = "legible_tests.rs"]
mod tests;
