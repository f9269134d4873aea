//! Options of a build (on the command line and in settings files) and tables of road and area
//! classes, parsed from text and checked; and the built-in tables.
//!
//! This crate never opens a file, never chooses the defaults of missing settings, and never
//! draws.

mod areas;
mod bounds;
mod build_options;
mod class_cells;
mod class_labels;
mod classes;
mod error;
mod files;
mod folder;
mod frc;
mod layers;
mod photo;
mod values;

pub use areas::{area_preset, area_preset_names, parse_area_table};
pub use bounds::BoundsChoice;
pub use build_options::{
    AreaOptions, Config, InputFiles, PhotoOptions, ResourceOptions, RoadOptions, TerrainOptions,
};
pub use class_cells::class_filter;
pub use class_labels::class_labels;
pub use classes::Classes;
pub use error::PresetError;
pub use files::OutputFiles;
pub use frc::{frc_preset, frc_preset_names, parse_frc_table};
pub use layers::{layer_preset, layer_preset_names, parse_layer_table};
pub use photo::is_photo_off;
pub use values::{Words, one_of, parse_bytes};
