//! The tables and styles that come with Corniche, as texts in TOML: each file of this folder with its name.
//!
//! `presets` and `styles` read them; examples and tests take them from here too. This crate never reads, checks or
//! changes a text, and depends on nothing.

/// Tables from `highway=*` to the functional road class, the default one first.
pub const FRC_TABLES: &[(&str, &str)] = &[
    ("default", include_str!("frc/default.toml")),
    ("valhalla", include_str!("frc/valhalla.toml")),
    ("fraunhofer", include_str!("frc/fraunhofer.toml")),
    ("itinero", include_str!("frc/itinero.toml")),
    ("here5", include_str!("frc/here5.toml")),
];

/// Tables from tags to the classes of areas, the default one first.
pub const AREA_TABLES: &[(&str, &str)] = &[("default", include_str!("areas/default.toml"))];

/// Styles of the map, the default one first.
pub const STYLES: &[(&str, &str)] = &[
    ("road-atlas", include_str!("styles/road-atlas.toml")),
    ("dark", include_str!("styles/dark.toml")),
    ("relief", include_str!("styles/relief.toml")),
    ("photo", include_str!("styles/photo.toml")),
];

/// A settings file of `corniche build --config` with every key, each commented out.
pub const BUILD_SETTINGS: &str = include_str!("build.toml");
