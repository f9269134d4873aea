//! Options for photos of the ground.

use std::path::{Path, PathBuf};

/// Whether these names of photos are the one word that says that no photos are wanted. A file of this name is `./off`.
#[must_use]
pub fn is_photo_off(names: &[PathBuf]) -> bool {
    names == [Path::new("off")]
}
