//! The styles that come with the program.

/// Styles that come with the program, the default one first.
const PRESETS: [(&str, &str); 4] = [
    ("road-atlas", include_str!("../sheets/road-atlas.toml")),
    ("dark", include_str!("../sheets/dark.toml")),
    ("relief", include_str!("../sheets/relief.toml")),
    ("photo", include_str!("../sheets/photo.toml")),
];

/// Names of the styles that come with the program, the default one first.
pub fn style_preset_names() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|(name, _)| *name)
}

/// The text of the style of this name that comes with the program, for [`parse_style`](crate::parse_style).
#[must_use]
pub fn style_preset(name: &str) -> Option<&'static str> {
    PRESETS.iter().find(|(preset, _)| *preset == name).map(|(_, text)| *text)
}
