//! The package while it is written: a file beside the target, which gets the target's name when it is complete.

use std::{
    fs::{self, File},
    io,
    path::{Path, PathBuf},
};

use tempfile::NamedTempFile;

use crate::{BuildError, Existing, unfinished_file};

/// The file that becomes the package. It is removed when the build fails; what a killed build leaves is removed by the next one.
pub(crate) struct Unfinished {
    file: NamedTempFile,
    folder: PathBuf,
}

impl Unfinished {
    /// Makes the file in `folder`, that of the target, and locks it: of two builds of one target one is refused.
    pub(crate) fn create(target: &Path, folder: &Path) -> Result<Self, BuildError> {
        let folder = folder.to_path_buf();
        match unfinished_file(target) {
            Ok(file) => Ok(Self { file, folder }),
            Err(error) if error.kind() == io::ErrorKind::ResourceBusy => {
                Err(BuildError::AtWork { path: target.to_path_buf() })
            }
            Err(source) => Err(BuildError::Target { folder, source }),
        }
    }

    pub(crate) fn path(&self) -> &Path {
        self.file.path()
    }

    /// Writes the finished package's bytes to the disk, then moves the file to its place, and makes its name durable. Returns
    /// its size.
    pub(crate) fn place(self, target: &Path, existing: Existing) -> Result<u64, BuildError> {
        let failed = |source| BuildError::Rename { path: target.to_path_buf(), source };
        let Self { file, folder } = self;
        file.as_file().sync_all().map_err(failed)?;
        let bytes = file.as_file().metadata().map_err(failed)?.len();
        let persist =
            |file: NamedTempFile| file.persist(target).map_err(|error| failed(error.error));
        match existing {
            Existing::Replace => drop(persist(file)?),
            // A link fails where a rename would replace what someone put there while the build ran.
            Existing::Keep => match fs::hard_link(file.path(), target) {
                // The package has two names now. The other one goes at once, so that nobody takes it for a leftover.
                Ok(()) => file.close().map_err(failed)?,
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    return Err(BuildError::Exists { path: target.to_path_buf() });
                }
                // Not every file system has hard links. Without them only the check at the start protects an existing file.
                Err(_) => drop(persist(file)?),
            },
        }
        sync_folder(&folder).map_err(failed)?;
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
