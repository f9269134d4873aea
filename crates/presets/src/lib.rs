//! What people write down in TOML: settings files, FRC tables and styles, checked; and the presets that come with the
//! program.
//!
//! This crate never opens a file, never decides what a setting that is left out means, and never draws.

mod class_cells;
mod config;
mod frc;
mod style;

mod error;

pub use class_cells::class_filter;
pub use config::{CellSides, Config, ResourceConfig, RoadConfig, TerrainConfig};
pub use error::PresetError;
pub use frc::{frc_preset, frc_preset_names, parse_frc_table};
pub use style::{
    BackgroundSheet, CenterSheet, LightSheet, Rgb8, RoadSheet, StyleSheet, TINT_COLORS, TintSheet,
    WidthScalingSheet, parse_style, style_preset, style_preset_names,
};
