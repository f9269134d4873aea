//! Ctrl-C and the polite signals: the run stops at the next opportunity and cleans up; the second one ends at once.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::Failure;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// From now on a signal is noted instead of ending the program.
pub(crate) fn watch() -> Result<(), Failure> {
    ctrlc::set_handler(|| {
        if INTERRUPTED.swap(true, Ordering::SeqCst) {
            std::process::exit(4);
        }
    })
    .map_err(|error| Failure::new(crate::exit::ExitCode::Failed, error))
}

/// Whether a signal came.
pub(crate) fn is_noted() -> bool {
    INTERRUPTED.load(Ordering::SeqCst)
}
