//! The inputs and rules of a package: settings, input files, grid and levels. The build and its
//! check use the same ones.
//!
//! ```text
//!   settings ─► record of the manifest        inputs ─► hashes, changes
//!   grid ─► levels, tiles with data, true lengths and areas
//! ```
//!
//! This crate creates no plan, and reads neither heights nor roads.

pub mod artifacts;
pub mod data_outline;
pub mod data_tiles;
pub mod extent;
pub mod hex;
pub mod inputs;
pub mod levels;
pub mod machine;
pub mod manifest_texts;
pub mod memory_shares;
pub mod points_step;
pub mod settings_record;
pub mod tiles_near;
pub mod true_areas;
pub mod true_lengths;

mod defect;
mod extract_bounds;
mod open_package;
mod settings;

pub use defect::{BuildObserver, Defect, Loss, span_reason_words, span_reasons};
pub use extract_bounds::{ExtractBoundsError, extract_bounds};
pub use open_package::open_package;
pub use settings::{
    BuildSettings, Leftovers, PhotoChoice, PhotoSettings, PlanSettings, Resources, RoadSettings,
    TerrainSettings, usual_max_error_m,
};
