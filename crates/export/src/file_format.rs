//! What formats of several kinds of files have in common: an ending that says which one it is.

use std::path::Path;

/// A format that the ending of a file's name says.
pub trait FileFormat: Copy + 'static {
    /// All of its kind.
    const ALL: &[Self];

    /// The ending of its files, without the point.
    fn ending(self) -> &'static str;

    /// The format of a file by its ending, in capitals or not; `None` for another ending.
    #[must_use]
    fn of_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL.iter().copied().find(|format| format.ending() == ending)
    }
}
