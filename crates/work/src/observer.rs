//! The interface by which work reports its stages and progress and learns that it should stop.

use std::path::Path;

use crate::Stage;

/// Work was cancelled by its [`Observer`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Interrupted;

/// Lets an error that has a variant `Interrupted` be made of [`Interrupted`].
#[macro_export]
macro_rules! from_interrupted {
    ($error:ty) => {
        impl From<$crate::Interrupted> for $error {
            fn from(_: $crate::Interrupted) -> Self {
                Self::Interrupted
            }
        }
    };
}

/// What work reports to its caller, and how the caller stops it.
pub trait Observer: Sync {
    /// A stage begins; `total` is how many of its [`Unit`](crate::Unit)s it will count up to, where that is known. Stages do not overlap.
    fn begin(&self, _: Stage, _total: Option<u64>) {}

    /// An earlier run did `steps` of the total. They count as done, but say nothing about how fast this run is.
    fn already(&self, _: Stage, _steps: u64) {}

    /// The stage has done `steps` more.
    fn advance(&self, _: Stage, _steps: u64) {}

    /// The stage has done `done` in all, of a `total` that is known only now or that changed.
    fn reached(&self, _: Stage, _done: u64, _total: u64) {}

    /// The stage is over.
    fn end(&self, _: Stage) {}

    /// The run uses this file or folder and removes it when it ends. A caller that ends the program without waiting for the run
    /// removes it itself.
    fn temporary(&self, _: &Path) {}

    /// The run keeps its intermediate results in this folder, and may be gone on from there if it ends early. A caller that ends the program without
    /// waiting for the run tells so itself.
    fn keeps(&self, _: &Path) {}

    /// A warning about the inputs, as text for the user.
    fn warning(&self, _: &str) {}

    /// Whether to stop at the next opportunity; the run then fails with [`Interrupted`].
    fn is_cancelled(&self) -> bool {
        false
    }

    /// Goes on unless the run is cancelled.
    ///
    /// # Errors
    /// [`Interrupted`] if it is.
    fn check(&self) -> Result<(), Interrupted> {
        if self.is_cancelled() { Err(Interrupted) } else { Ok(()) }
    }
}

/// An observer that ignores all reports and never cancels.
#[derive(Debug, Clone, Copy)]
pub struct Silent;

impl Observer for Silent {}
