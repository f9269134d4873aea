//! How a window ends, and why there is none.

use std::{io, path::PathBuf};

use corniche_viewer::{
    OffGround, OutOfRange,
    gpu::{GpuError, ReadBackError},
    tiles::LoadTileError,
};

use crate::NotSaved;

/// What came of a window.
#[derive(Debug)]
pub struct Closed {
    /// Why it is closed.
    pub end: Result<End, WindowError>,
    /// What became of the files that were saved after the last frame, for which the window could show no message any more.
    pub last_files: Vec<Result<PathBuf, NotSaved>>,
}

/// How a window ends when nothing fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The person closed it.
    Closed,
    /// [`WindowRequest::is_stopped`](crate::WindowRequest::is_stopped) said so.
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
