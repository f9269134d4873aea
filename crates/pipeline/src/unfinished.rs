//! The file that is written beside its target until it is complete.
//!
//! Its name follows from the target's, so that one which a killed program left is found and removed. A lock, which the kernel gives back, tells
//! it from one that is being written.

use std::{
    fs::{self, File, TryLockError},
    io,
    path::{Path, PathBuf},
};

use tempfile::{NamedTempFile, TempPath};

use crate::Existing;

/// How often it is tried again when another program removes what was just made, because it took it for a leftover.
const TRIES: usize = 5;

/// Makes the file that becomes `target`: `.NAME.unfinished` beside it. It is removed when it is dropped.
///
/// # Errors
/// Of kind `ResourceBusy` if another program writes it; else where the folder cannot be written.
pub fn unfinished_file(target: &Path) -> io::Result<NamedTempFile> {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    let path = target.with_file_name(format!(".{name}.unfinished"));
    for _ in 0..TRIES {
        match File::options().write(true).create_new(true).open(&path) {
            Ok(file) => {
                lock(&file)?;
                if is_at(&file, &path)? {
                    return Ok(NamedTempFile::from_parts(file, TempPath::try_from_path(path)?));
                }
            }
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => remove_leftover(&path)?,
            Err(error) => return Err(error),
        }
    }
    Err(busy())
}

/// Writes the bytes of a finished file to the disk, moves it to its target, and makes its name durable. Returns its size.
///
/// # Errors
/// Of kind `AlreadyExists` if there is something at the target that is to be kept; else when the disk does not take it.
pub fn place_finished(path: TempPath, target: &Path, existing: Existing) -> io::Result<u64> {
    let file = File::open(&path)?;
    file.sync_all()?;
    let bytes = file.metadata()?.len();
    let placed = match existing {
        Existing::Replace => path.persist(target),
        // This fails where the other would replace what someone put there in the meantime.
        Existing::Keep => match path.persist_noclobber(target) {
            // Not every file system can do that. Without it only the check at the start protects an existing file.
            Err(refused) if refused.error.kind() != io::ErrorKind::AlreadyExists => {
                refused.path.persist(target)
            }
            placed => placed,
        },
    };
    placed.map_err(|refused| refused.error)?;
    sync_folder(folder_of(target))?;
    Ok(bytes)
}

/// The folder that a file is in, or will be: the working folder where its name says none.
#[must_use]
pub fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes the names in a folder durable.
#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

fn busy() -> io::Error {
    io::Error::new(io::ErrorKind::ResourceBusy, "another program is writing it")
}

fn lock(file: &File) -> io::Result<()> {
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err(busy()),
        // Some network file systems have no locks. There the last one to finish wins.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(()),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// Removes a file that nobody writes any more.
fn remove_leftover(path: &PathBuf) -> io::Result<()> {
    if !fs::symlink_metadata(path)?.is_file() {
        let what = format!("{} is in the way; move it away", path.display());
        return Err(io::Error::new(io::ErrorKind::AlreadyExists, what));
    }
    let file = File::options().write(true).open(path)?;
    lock(&file)?;
    if is_at(&file, path)? { fs::remove_file(path) } else { Ok(()) }
}

/// Whether an open file still has this name.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt as _;
    let named = match fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(false),
        named => named?,
    };
    let file = file.metadata()?;
    Ok((file.dev(), file.ino()) == (named.dev(), named.ino()))
}

/// Elsewhere an open file keeps its name.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> io::Result<bool> {
    Ok(true)
}

#[cfg(test)]
#[path = "unfinished_tests.rs"]
mod tests;
