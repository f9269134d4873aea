//! The package while it is written: a file beside the target, which gets the target's name when it is complete.

use std::{
    fs::{self, File},
    io,
    path::{Path, PathBuf},
};

use crate::{BuildError, Existing};

/// The file that becomes the package. It is removed when the build fails. After a build that was killed it stays until the next
/// one takes it over.
pub(crate) struct Unfinished {
    path: PathBuf,
    /// Holds the lock.
    _file: File,
}

impl Unfinished {
    /// Makes the file in `folder`, that of the target, and locks it: of two builds of one target one is refused.
    pub(crate) fn create(target: &Path, folder: &Path) -> Result<Self, BuildError> {
        let unusable = |source| BuildError::Target { folder: folder.to_path_buf(), source };
        let name = target.file_name().unwrap_or_default().to_string_lossy();
        let path = target.with_file_name(format!(".{name}.unfinished"));
        let file = File::options()
            .create(true)
            .write(true)
            .truncate(false)
            .open(&path)
            .map_err(unusable)?;
        match file.try_lock() {
            Ok(()) => Ok(Self { path, _file: file }),
            Err(fs::TryLockError::WouldBlock) => {
                Err(BuildError::AtWork { path: target.to_path_buf() })
            }
            // Some network file systems have no locks; the store has one of its own.
            Err(fs::TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {
                Ok(Self { path, _file: file })
            }
            Err(fs::TryLockError::Error(error)) => Err(unusable(error)),
        }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the finished package's bytes to the disk, then moves the file to its place. Returns its size.
    pub(crate) fn place(&self, target: &Path, existing: Existing) -> Result<u64, BuildError> {
        let failed = |source| BuildError::Rename { path: target.to_path_buf(), source };
        let file = File::options().write(true).open(&self.path).map_err(failed)?;
        file.sync_all().map_err(failed)?;
        let bytes = file.metadata().map_err(failed)?.len();
        match existing {
            Existing::Replace => fs::rename(&self.path, target).map_err(failed)?,
            // A link fails where a rename would replace what someone put there while the build ran.
            Existing::Keep => match fs::hard_link(&self.path, target) {
                Ok(()) => {}
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    return Err(BuildError::Exists { path: target.to_path_buf() });
                }
                // Not every file system has hard links. Without them only the check at the start protects an existing file.
                Err(_) => fs::rename(&self.path, target).map_err(failed)?,
            },
        }
        Ok(bytes)
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        // It may have got its place already.
        let _ = fs::remove_file(&self.path);
    }
}
