//! The package while it is written: a file beside the target, which gets the target's name when it is complete.

#[cfg(unix)]
use std::fs::File;
use std::{io, path::Path};

use tempfile::NamedTempFile;

use super::destination::Destination;
use crate::{BuildError, Existing, unfinished_file};

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

    /// Writes the finished package's bytes to the disk, then moves the file to its place, and makes its name durable. Returns
    /// its size.
    pub(crate) fn place(self, destination: &Destination) -> Result<u64, BuildError> {
        let Destination { target, folder, existing } = destination;
        let failed = |source| BuildError::Rename { path: target.clone(), source };
        let file = self.file;
        file.as_file().sync_all().map_err(failed)?;
        let bytes = file.as_file().metadata().map_err(failed)?.len();
        let placed = match existing {
            Existing::Replace => file.persist(target),
            // This fails where the other would replace what someone put there while the build ran.
            Existing::Keep => match file.persist_noclobber(target) {
                Err(refused) if refused.error.kind() == io::ErrorKind::AlreadyExists => {
                    return Err(BuildError::Exists { path: target.clone() });
                }
                // Not every file system can do that. Without it only the check at the start protects an existing file.
                Err(refused) => refused.file.persist(target),
                placed => placed,
            },
        };
        placed.map_err(|refused| failed(refused.error))?;
        sync_folder(folder).map_err(failed)?;
        Ok(bytes)
    }
}

/// Makes the names in a folder durable: a store is removed only after that.
#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}
