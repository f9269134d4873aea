//! A window on a package: what moves the camera, what is shown beside the map.
//!
//! ```text
//!  system ──► platform ──► app ── inputs ──► controls ──► camera ──► tiles ──► canvas ──► surface
//!                           ▲                                          │         ▲
//!                           └──────────── panel, hud ◄── facts         ▼         │
//!                                                                   loader ── decoded tiles
//! ```
//!
//! [`run`] opens the window and returns when it is closed; [`watch`] opens one on pictures that come from elsewhere. `platform` is the one module that knows the window system;
//! `canvas` is all that lies on the graphics card; `app` is the rest, and knows neither a window nor a clock. Nothing is
//! drawn while nothing moves, loads or is touched.
//!
//! This crate never reads elevation files or extracts and never computes geometry; pictures of the map are
//! `corniche-viewer`'s.

mod app;
mod canvas;
mod clicks;
pub mod controls;
mod facts;
mod frame_times;
mod hud;
mod loader;
mod panel;
mod platform;
mod recorder;
mod settings;
mod shots;
mod tiles;
mod trace;
mod words;

use std::path::PathBuf;

use corniche_tileset::OpenError;
use corniche_viewer::{
    CameraRequest, RoadOptions,
    gpu::{GpuError, ReadBackError},
    stream::StreamBudget,
    style::Style,
    tiles::LoadTileError,
};

pub use platform::{Watched, run, watch};

/// A style and what it is called.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedStyle {
    /// As the panel lists it.
    pub name: String,
    /// It.
    pub style: Style,
}

/// Asked about once a second whether the first style has changed; what it says is shown: the new style, or in words why
/// there is none, and then the old one stays.
pub type Reload = Box<dyn FnMut() -> Option<Result<Style, String>>>;

/// What to open and how.
pub struct WindowRequest {
    /// The package.
    pub package: PathBuf,
    /// Width and height of the window's inside at first, pixels.
    pub size_px: [u32; 2],
    /// Where to look from at first.
    pub camera: CameraRequest,
    /// How roads are drawn at first.
    pub roads: RoadOptions,
    /// Styles to choose from, at least one; the first is shown at first.
    pub styles: Vec<NamedStyle>,
    /// Whether the first style has changed; `None` if it cannot.
    pub reload: Option<Reload>,
    /// A tile is refined while its error looks larger than this, pixels.
    pub screen_space_error_px: f64,
    /// Factor on heights; 1 is true.
    pub exaggeration: f64,
    /// Samples per pixel along each side; without it 2, and 1 where the processor draws.
    pub samples_per_side: Option<u32>,
    /// What may be loaded and kept.
    pub budget: StreamBudget,
    /// Whether movements run out softly.
    pub inertia: controls::Inertia,
    /// Where pictures and flights are saved.
    pub folder: PathBuf,
    /// A diagnostic: a file that gets a line for each frame.
    pub trace: Option<PathBuf>,
}

/// Why there is no window, or none any more.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum WindowError {
    #[error(
        "there is no display to open a window on ({reason}); `corniche render` and `corniche fly` need none"
    )]
    NoDisplay { reason: String },
    #[error("the window system failed")]
    System { source: Box<dyn std::error::Error + Send + Sync> },
    #[error("the window gives no surface to draw on")]
    Surface { source: Box<dyn std::error::Error + Send + Sync> },
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error(transparent)]
    Load(#[from] LoadTileError),
    #[error("{package:?} has no ground to show")]
    NoGround { package: PathBuf },
    #[error(
        "longitude {lon_deg}, latitude {lat_deg} has no ground: it lies in a void, at the data's edge or outside the \
         package, which covers {covered_deg:?} (west, south, east, north in degrees)"
    )]
    OffGround { lon_deg: f64, lat_deg: f64, covered_deg: [f64; 4] },
    #[error("{name} of {value} is out of range; it must be {range}")]
    Range { name: &'static str, value: f64, range: &'static str },
    #[error("a window needs a style to show the map in; give at least one")]
    NoStyle,
    #[error("the system gives no thread to load tiles in")]
    Thread { source: std::io::Error },
    #[error("cannot write the trace {path:?}")]
    Trace { path: PathBuf, source: std::io::Error },
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    ReadBack(#[from] ReadBackError),
    #[error("the adapter {adapter:?} cannot show pictures in a window of this system")]
    NoFormat { adapter: String },
    #[error(
        "the graphics device was lost twice; the driver may be at fault, or WGPU_BACKEND may choose another one"
    )]
    DeviceLost,
}
