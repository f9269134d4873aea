use crate::error::ExportError;

/// What an export is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Work {
    /// Reads tiles and sorts what they hold by way.
    Tiles,
    /// Joins the pieces of each way and writes features.
    Pieces,
}

/// Who waits for an export: is told how far it is, and may end it.
pub trait Watch {
    /// So much of so much is done.
    fn done(&self, work: Work, done: u64, total: u64);

    /// Whether the export is to end. It is asked for each tile and for each way.
    fn should_stop(&self) -> bool;
}

/// Ends the work if that is wanted.
pub(crate) fn stop_if_asked(watch: &dyn Watch) -> Result<(), ExportError> {
    if watch.should_stop() { Err(ExportError::Interrupted) } else { Ok(()) }
}

/// Nobody waits.
#[derive(Debug, Clone, Copy)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn done(&self, _: Work, _: u64, _: u64) {}

    fn should_stop(&self) -> bool {
        false
    }
}
