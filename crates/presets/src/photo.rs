//! Options for photos of the ground.

use std::path::{Path, PathBuf};

/// Whether these names of photos are the single word that turns photos off. A file of this name is
/// `./off`.
#[must_use]
pub fn is_photo_off(names: &[PathBuf]) -> bool {
    names == [Path::new("off")]
}
