//! Options of a build (on the command line and in settings files) and FRC tables, read from text and checked; and the FRC
//! tables that come with the program.
//!
//! This crate never opens a file, never decides what a setting that is left out means, and never draws.

mod bounds;
mod class_cells;
mod classes;
mod config;
mod error;
mod files;
mod folder;
mod frc;
mod photo;
mod relief;
mod values;

pub use bounds::BoundsChoice;
pub use class_cells::class_filter;
pub use classes::Classes;
pub use config::{Config, ResourceOptions, RoadOptions, TerrainOptions};
pub use error::PresetError;
pub use files::{InputFiles, OutputFiles};
pub use frc::{frc_preset, frc_preset_names, parse_frc_table};
pub use photo::PhotoOptions;
pub use relief::ReliefChoice;
pub use values::{check_cell, is_range, parse_bytes, parse_memory};
