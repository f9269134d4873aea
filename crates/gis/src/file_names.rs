//! Lists of files in messages.

use std::path::Path;

/// Most files that a message names.
const MAX_NAMES: usize = 3;

/// The first few names, and how many more there are.
#[must_use]
pub fn first_names(names: impl ExactSizeIterator<Item = String>) -> String {
    names_up_to(MAX_NAMES, names)
}

/// Up to so many names, and how many more there are.
#[must_use]
pub fn names_up_to(most: usize, names: impl ExactSizeIterator<Item = String>) -> String {
    let more = names.len().saturating_sub(most);
    let told = names.take(most).collect::<Vec<_>>().join(", ");
    if more == 0 { told } else { format!("{told} and {more} more") }
}

/// Files as a message names them: quoted, and no more than are read.
#[must_use]
pub fn listed_files<F: AsRef<Path>>(files: &[F]) -> String {
    first_names(files.iter().map(|file| format!("\"{}\"", file.as_ref().display())))
}
