//! A window on a package: what moves the camera, what is shown beside the map.
//!
//! ```text
//!  system ──► platform ──► app ── inputs ──► controls ──► camera ──► tiles ──► canvas ──► surface
//!                           ▲                                          │         ▲
//!                           └──────────── panel, hud ◄── facts         ▼         │
//!                                                                   loader ── decoded tiles
//! ```
//!
//! [`run`] opens the window and returns when it is closed; [`watch`] opens one on pictures that come from elsewhere.
//! `platform` is the one module that knows the window system, threads and files; `canvas` is all that lies on the graphics
//! card; `app` is the rest, and knows neither a window nor a clock. Nothing is drawn while nothing moves, loads or is
//! touched.
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
mod notices;
mod panel;
mod platform;
mod recorder;
mod settings;
mod shots;
mod tiles;
mod trace;
mod words;

use std::{io, path::PathBuf, sync::Arc};

use corniche_styles::Style;
use corniche_viewer::{
    CameraRequest, OffGround, OutOfRange, RoadOptions, ViewpointError,
    gpu::{GpuError, ReadBackError},
    stream::StreamBudget,
    tiles::{LoadTileError, PackageSource},
};

pub use platform::{Watched, run, watch};
pub use shots::NotSaved;

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

/// Begins the trace once there is a window to tell of. What is written appears at once to whoever reads along.
pub type BeginTrace = Box<dyn FnOnce() -> io::Result<Box<dyn io::Write>>>;

/// What to open and how.
pub struct WindowRequest {
    /// What the package is called.
    pub name: String,
    /// The package.
    pub source: Arc<PackageSource>,
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
    /// Where pictures and flights are saved, never in the place of another file.
    pub folder: PathBuf,
    /// A diagnostic: what gets a line for each frame.
    pub trace: Option<BeginTrace>,
    /// Asked several times a second whether the program is to end, by a signal for instance.
    pub is_stopped: Box<dyn Fn() -> bool>,
}

/// What came of a window.
#[derive(Debug)]
pub struct Closed {
    /// Why it is closed.
    pub end: Result<End, WindowError>,
    /// The files saved last, and those that could not be: there was no window any more to say so. What it said itself is
    /// not among them.
    pub last_files: Vec<Result<PathBuf, NotSaved>>,
}

/// How a window ends when nothing fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The person closed it.
    Closed,
    /// [`WindowRequest::is_stopped`] said so.
    Stopped,
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
    Load(#[from] LoadTileError),
    #[error("{name:?} has no ground to show")]
    NoGround { name: String },
    #[error(
        "the package's coarsest tile takes {wanted_bytes} bytes, more than the {budget_bytes} bytes of graphics memory \
         allowed; allow more (--gpu-memory)"
    )]
    OverBudget { wanted_bytes: u64, budget_bytes: u64 },
    #[error(transparent)]
    OffGround(#[from] OffGround),
    #[error(transparent)]
    Range(#[from] OutOfRange),
    #[error("a window needs a style to show the map in; give at least one")]
    NoStyle,
    #[error("the system gives no thread to load tiles in")]
    Thread { source: io::Error },
    #[error("cannot write the trace")]
    Trace { source: io::Error },
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    ReadBack(#[from] ReadBackError),
    #[error("the adapter {adapter:?} cannot show pictures in a window of this system")]
    NoFormat { adapter: String },
    #[error(
        "the graphics device was lost twice within a minute; the driver may be at fault, or WGPU_BACKEND may choose another one"
    )]
    DeviceLost,
}

impl From<ViewpointError> for WindowError {
    fn from(error: ViewpointError) -> Self {
        match error {
            ViewpointError::OffGround(off_ground) => Self::OffGround(off_ground),
            ViewpointError::Load(load) => Self::Load(load),
        }
    }
}
