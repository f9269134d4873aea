//! The end of a window, and the reasons why a window cannot be shown.

use std::{io, path::PathBuf};

use corniche_viewer::{
    OutOfRange, ViewpointOffGround,
    gpu::{GpuError, ReadBackError},
    tiles::LoadTileError,
};

use crate::NotSaved;

/// The result of a window.
#[derive(Debug)]
pub struct Closed {
    /// The reason why the window is closed.
    pub end: Result<WindowEnd, WindowError>,
    /// The results of the files that were saved after the last frame, when the window could show no
    /// message any more.
    pub last_files: Vec<Result<PathBuf, NotSaved>>,
}

/// The end of a window without failures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WindowEnd {
    /// The user closed the window.
    Closed,
    /// [`WindowRequest::is_stopped`](crate::WindowRequest::is_stopped) returned true.
    Stopped,
}

/// The reason why a window cannot be opened or kept open.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum WindowError {
    #[error(
        "there is no display to open a window on ({reason}); `corniche render` and `corniche fly` \
         work without one"
    )]
    NoDisplay { reason: String },
    #[error("the window system failed")]
    System { source: Box<dyn std::error::Error + Send + Sync> },
    #[error("the window provides no surface to draw on")]
    Surface { source: Box<dyn std::error::Error + Send + Sync> },
    #[error(transparent)]
    Load(#[from] LoadTileError),
    #[error("{name:?} has no ground to show")]
    NoGround { name: String },
    #[error(
        "the package's coarsest tile takes {wanted_bytes} bytes, more than the {budget_bytes} \
         bytes of graphics memory allowed; raise the limit (--gpu-memory)"
    )]
    OverBudget { wanted_bytes: u64, budget_bytes: u64 },
    #[error(transparent)]
    OffGround(#[from] ViewpointOffGround),
    #[error(transparent)]
    Range(#[from] OutOfRange),
    #[error("a window needs at least one style; pass one")]
    NoStyle,
    #[error("the system cannot start a thread for loading tiles")]
    Thread { source: io::Error },
    #[error("cannot write the trace")]
    Trace { source: io::Error },
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    ReadBack(#[from] ReadBackError),
    #[error("the adapter {adapter:?} cannot draw to a window on this system")]
    NoFormat { adapter: String },
    #[error(
        "the graphics device was lost twice within a minute; update the driver, or choose another backend with WGPU_BACKEND"
    )]
    DeviceLost,
}
