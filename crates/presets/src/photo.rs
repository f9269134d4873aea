//! Options for photos of the ground.

use std::path::{Path, PathBuf};

use crate::PhotoOptions;

/// Whether these names of photos are the one word that says that no photos are wanted. A file of this name is `./off`.
#[must_use]
pub fn is_photo_off(names: &[PathBuf]) -> bool {
    names == [Path::new("off")]
}

impl PhotoOptions {
    /// Whether nothing is given.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}
