//! The built-in tables and styles of Corniche, as TOML texts: each file of this folder with its
//! name.
//!
//! `presets` and `styles` parse them; examples and tests use them, too. This crate never reads,
//! checks or changes a text, and has no dependencies.

/// Tables from `highway=*` to the functional road class, the default one first.
pub const FRC_TABLES: &[(&str, &str)] = &[
    ("default", include_str!("frc/default.toml")),
    ("valhalla", include_str!("frc/valhalla.toml")),
    ("fraunhofer", include_str!("frc/fraunhofer.toml")),
    ("itinero", include_str!("frc/itinero.toml")),
    ("here5", include_str!("frc/here5.toml")),
];

/// Layers of the map: which objects of an extract they contain, in which classes.
pub const LAYERS: &[(&str, &str)] = &[
    ("areas", include_str!("layers/areas.toml")),
    ("boundaries", include_str!("layers/boundaries.toml")),
    ("railways", include_str!("layers/railways.toml")),
    ("waterways", include_str!("layers/waterways.toml")),
    ("buildings", include_str!("layers/buildings.toml")),
    ("landforms", include_str!("layers/landforms.toml")),
    ("ferries", include_str!("layers/ferries.toml")),
    ("places", include_str!("layers/places.toml")),
    ("peaks", include_str!("layers/peaks.toml")),
    ("pois", include_str!("layers/pois.toml")),
];

/// Styles of the map, the default one first.
pub const STYLES: &[(&str, &str)] = &[
    ("road-atlas", include_str!("styles/road-atlas.toml")),
    ("dark", include_str!("styles/dark.toml")),
    ("relief", include_str!("styles/relief.toml")),
    ("photo", include_str!("styles/photo.toml")),
];

/// A settings file of `corniche build --config` with every key, each commented out.
pub const BUILD_SETTINGS: &str = include_str!("build.toml");
