//! The package while it is written: a file beside the target, which gets the target's name when it is complete.

use std::{io, path::Path};

use tempfile::NamedTempFile;

use super::destination::Destination;
use crate::{BuildError, place_finished, unfinished_file};

/// The file that becomes the package. It is removed when the build fails; what a killed build leaves is removed by the next one.
pub(crate) struct Unfinished {
    file: NamedTempFile,
}

impl Unfinished {
    /// Makes the file and locks it: of two builds of one target one is refused.
    pub(crate) fn create(destination: &Destination) -> Result<Self, BuildError> {
        let Destination { target, folder, .. } = destination;
        match unfinished_file(target) {
            Ok(file) => Ok(Self { file }),
            Err(error) if error.kind() == io::ErrorKind::ResourceBusy => {
                Err(BuildError::AtWork { path: target.clone() })
            }
            Err(source) => Err(BuildError::Target { folder: folder.clone(), source }),
        }
    }

    pub(crate) fn path(&self) -> &Path {
        self.file.path()
    }

    /// Moves the finished package to its place, durably; the store is removed only after that. Returns its size.
    pub(crate) fn place(self, destination: &Destination) -> Result<u64, BuildError> {
        let Destination { target, existing, .. } = destination;
        // The file is held, and with it its lock, until it is in its place.
        let (_held, path) = self.file.into_parts();
        place_finished(path, target, *existing).map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => BuildError::Exists { path: target.clone() },
            _ => BuildError::Rename { path: target.clone(), source: error },
        })
    }
}
