//! Options of a build (on the command line and in settings files) and tables of road classes and
//! layers, parsed from text and checked; and the built-in tables.
//!
//! This crate never opens a file, never chooses the defaults of missing settings, and never
//! draws.

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

pub use bounds::BoundsChoice;
pub use build_options::{
    Config, InputFiles, LayerOptions, PhotoOptions, ResourceOptions, RoadOptions, TerrainOptions,
};
pub use class_cells::class_filter;
pub use class_labels::class_labels;
pub use classes::{Classes, UnknownClass};
pub use error::PresetError;
pub use files::OutputFiles;
pub use frc::{frc_preset, frc_preset_names, parse_frc_table};
pub use layers::{is_no_layers, layer_preset, layer_preset_names, parse_layer_table};
pub use photo::is_photo_off;
pub use values::{Words, one_of, parse_bytes};
