//! The settings of a build, each declared once: [`settings!`] is the table.
//!
//! ```text
//!                    ┌─► presets: options of the command line and of settings files, merged and checked
//!   settings! ───────┼─► SettingsRecord: the manifest's keys, facts for comparisons, limits for readers
//!   (the table)      ├─► placed!: options ─► checked settings (cli) ⇄ record (spec)
//!                    └─► the schema of `corniche info --json` (tests of cli)
//! ```
//!
//! This crate never reads an option, opens a file or decides what a setting does.

mod record;
mod relief_levels;
mod table;
mod value;
mod value_records;

pub use record::{SettingFact, SettingSection, SettingsRecord};
pub use relief_levels::ReliefLevels;
pub use value::SettingValue;
pub use value_records::{LayerTableRecord, PhotoRecord, PolygonRecord};

/// The upper limit of lengths, heights and coordinates of a package: far beyond every planet, and
/// its square still fits an f32.
pub const MAX_MEASURE_M: f64 = 1e18;
/// The upper limit of the number of nodata values, more than any set of files has.
pub const MAX_NODATA: usize = 64;
