//! Errors of windows and of saving their pictures and flights.

use std::{io, path::PathBuf};

use corniche_viewer::{
    OffGround, OutOfRange,
    flight::FlightError,
    gpu::{GpuError, ReadBackError},
    tiles::LoadTileError,
};

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

/// Why a picture or a flight was not saved.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum NotSaved {
    #[error("nothing could be saved in {}", folder.display())]
    File { folder: PathBuf, source: io::Error },
    #[error("nothing was recorded")]
    Recording(#[from] FlightError),
    #[error("no picture was taken")]
    Picture(#[from] ReadBackError),
    #[error("no picture was taken: it was not yet drawn")]
    Untaken,
    #[error("no picture was taken: the graphics device was lost")]
    DeviceLost,
}
