//! Map styles: the values that the viewer draws with, the TOML text in which people write them, and
//! the built-in styles.
//!
//! ```text
//!  text (TOML) ──► parse_style ──► Style ──► viewer, window
//!       ▲            ▲
//!  style_preset ─────┘ base
//! ```
//!
//! This crate never opens a file, never draws and does not access a GPU, so that it also builds for
//! WebAssembly.

mod area_style;
mod base;
pub mod climate;
mod color;
mod dash;
mod error;
mod ground;
mod ground_sheet;
mod layer_looks;
mod layer_sheet;
mod line_style;
mod lines_as_roads;
mod point_style;
mod presets;
mod road_bands;
mod road_scale;
mod road_sheet;
mod sheet;
mod sheet_values;
mod style;

pub use self::color::{ColorError, Rgb, parse_color, to_bytes};
pub use area_style::AreaStyle;
pub use dash::Dash;
pub use error::StyleError;
pub use ground::{Light, MOST_TINT_STOPS, Tint, TintHeights, TintStop};
pub use layer_looks::{LayerLook, LayerLooks};
pub use line_style::LineStyle;
pub use point_style::PointStyle;
pub use presets::{style_preset, style_preset_names};
pub use road_bands::{RoadBand, RoadBands};
pub use road_scale::FADE_FACTOR;
pub use sheet::parse_style;
pub use style::{OwnWidths, RoadStyle, Style, WidthScaling};
