//! The interface by which work reports its stages and progress and learns that it should stop.

use std::path::Path;

use crate::Stage;

/// Work was cancelled by its [`Observer`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Interrupted;

/// Implements the conversion of [`Interrupted`] to an error with a variant `Interrupted`.
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
    /// A stage begins; `total` is the number of [`Unit`](crate::Unit)s it will count, if known.
    /// Stages do not overlap.
    fn begin(&self, _: Stage, _total: Option<u64>) {}

    /// An earlier run did `steps` of the total. They count as done, but not for the speed of this
    /// run.
    fn already(&self, _: Stage, _steps: u64) {}

    /// The stage has done `steps` more.
    fn advance(&self, _: Stage, _steps: u64) {}

    /// The stage has done `done` in all, out of a `total` that became known only now or that
    /// changed.
    fn reached(&self, _: Stage, _done: u64, _total: u64) {}

    /// The stage is over.
    fn end(&self, _: Stage) {}

    /// The run uses this temporary file or folder and removes it at the end. A caller that ends the
    /// program without waiting for the run removes it itself.
    fn temporary(&self, _: &Path) {}

    /// The run stores its intermediate results in this folder, from which it can be resumed if it
    /// ends early. A caller that ends the program without waiting for the run reports this itself.
    fn keeps(&self, _: &Path) {}

    /// A warning about the inputs, as text for the user.
    fn warning(&self, _: &str) {}

    /// Whether to stop at the next opportunity; the run then fails with [`Interrupted`].
    fn is_cancelled(&self) -> bool {
        false
    }

    /// Continues unless the run is cancelled.
    ///
    /// # Errors
    /// [`Interrupted`] if the run is cancelled.
    fn check(&self) -> Result<(), Interrupted> {
        if self.is_cancelled() { Err(Interrupted) } else { Ok(()) }
    }
}

/// An observer that ignores all reports and never cancels.
#[derive(Debug, Clone, Copy)]
pub struct Silent;

impl Observer for Silent {}
