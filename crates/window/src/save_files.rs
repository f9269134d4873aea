//! The interface by which a window saves files while it goes on drawing.

use std::{io, path::PathBuf};

use crate::NotSaved;

/// Makes the bytes of a file; called outside the thread that draws.
pub(crate) type Encode = Box<dyn FnOnce() -> io::Result<Vec<u8>> + Send>;

/// Saves files while the window goes on drawing. What it says of a file comes later, through [`SaveFiles::news`].
pub(crate) trait SaveFiles {
    /// Adds a file with the bytes that `encode` makes, under the next free number after `stem`.
    fn save(&mut self, stem: &'static str, extension: &'static str, encode: Encode);
    /// The files that were saved, or not, since this was called last; never waits.
    fn news(&mut self) -> Vec<Result<PathBuf, NotSaved>>;
    /// Waits until all files are written; the result is that of the files that [`SaveFiles::news`] did not yet tell of.
    fn finish(&mut self) -> Vec<Result<PathBuf, NotSaved>>;
}

#[cfg(test)]
#[path = "save_files_tests.rs"]
pub(crate) mod tests;
