//! What people write down in TOML: settings files and FRC tables, checked; and the presets that come with the program.
//!
//! This crate never opens a file, and never decides what a setting that is left out means.

mod class_cells;
mod config;
mod frc;

mod error;

pub use class_cells::class_filter;
pub use config::{Config, ResourceConfig, RoadConfig, TerrainConfig};
pub use error::PresetError;
pub use frc::{frc_preset, frc_preset_names, parse_frc_table};
