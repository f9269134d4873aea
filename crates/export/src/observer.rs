//! The interface by which an export tells how far it is and learns that it should end.

use crate::error::ExportError;

/// What an export is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Reads tiles: sorts what they hold by way, or makes what is written of them.
    Tiles,
    /// Makes blocks of a raster.
    Blocks,
    /// Joins the pieces of each way and writes features.
    Pieces,
}

/// Is told how far an export is, and may end it.
pub trait Observer {
    /// How many steps of a stage are done, of how many.
    fn done(&self, stage: Stage, done: u64, total: u64);

    /// Whether the export is to end. It is asked for each tile and for each way.
    fn should_stop(&self) -> bool;
}

/// Ends the work if that is wanted.
pub(crate) fn stop_if_asked(observer: &dyn Observer) -> Result<(), ExportError> {
    if observer.should_stop() { Err(ExportError::Interrupted) } else { Ok(()) }
}

/// Takes no notice, and never ends an export.
#[derive(Debug, Clone, Copy)]
pub struct Silent;

impl Observer for Silent {
    fn done(&self, _: Stage, _: u64, _: u64) {}

    fn should_stop(&self) -> bool {
        false
    }
}
