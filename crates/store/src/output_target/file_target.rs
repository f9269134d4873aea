//! The file to write for a path, and whether two paths lead to the same file.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use super::{claim::longest_name, own_files::folder_of};

/// Why a path cannot be the target of a file.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum TargetError {
    #[error("{path:?} names a folder; pass the name of a file")]
    Folder { path: PathBuf },
    #[error("{path:?} is {found} and cannot be overwritten; choose another name")]
    NoFile { path: PathBuf, found: &'static str },
    #[error(
        "{path:?} is a symbolic link to a file that does not exist; delete the link, or name the file that it should point to"
    )]
    DeadLink { path: PathBuf },
    #[error(
        "the name of {path:?} is too long for this file system, because a suffix is added to it while the file is written; choose a shorter name"
    )]
    LongName { path: PathBuf },
    #[error("{path:?} cannot be inspected")]
    Unknown { path: PathBuf, source: io::Error },
}

/// Returns the file to write for `path`: `path` itself, or the file to which a link there points,
/// so that the link is preserved.
///
/// A regular file exists at the returned path, or nothing; the caller decides whether an existing
/// file may be replaced.
///
/// # Errors
/// When `path` names a folder (also by ending in a slash), a link to a file that does not exist, or
/// something that is neither a file nor a folder: a device, a pipe, a socket. When the name is too
/// long for the file that is written next to it.
pub fn file_target(path: &Path) -> Result<PathBuf, TargetError> {
    let own = || path.to_path_buf();
    let ends_in_slash = path
        .as_os_str()
        .as_encoded_bytes()
        .last()
        .is_some_and(|&byte| std::path::is_separator(byte.into()));
    if ends_in_slash || path.file_name().is_none() {
        return Err(TargetError::Folder { path: own() });
    }
    let is_long = |name: &Path| {
        name.symlink_metadata().is_err_and(|error| error.kind() == io::ErrorKind::InvalidFilename)
    };
    if is_long(path) || is_long(&longest_name(path)) {
        return Err(TargetError::LongName { path: own() });
    }
    let unknown = |source| TargetError::Unknown { path: own(), source };
    let there = match path.symlink_metadata() {
        Ok(there) => there,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(own()),
        // A component of the path is a file instead of a folder.
        Err(error) => return Err(unknown(error)),
    };
    let is_link = there.file_type().is_symlink();
    let kind = if is_link {
        match fs::metadata(path) {
            Ok(found) => found.file_type(),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Err(TargetError::DeadLink { path: own() });
            }
            Err(error) => return Err(unknown(error)),
        }
    } else {
        there.file_type()
    };
    match kind {
        kind if kind.is_dir() => Err(TargetError::Folder { path: own() }),
        kind if !kind.is_file() => Err(TargetError::NoFile { path: own(), found: name_of(kind) }),
        _ if is_link => fs::canonicalize(path).map_err(unknown),
        _ => Ok(own()),
    }
}

/// Whether two paths lead to the same file, which need not exist yet.
#[must_use]
pub fn is_same_file(one: &Path, other: &Path) -> bool {
    place_of(one) == place_of(other)
}

/// Returns the absolute path of a file, however its path is written: if it does not exist yet, from
/// the location of its folder.
fn place_of(path: &Path) -> PathBuf {
    if let Ok(place) = path.canonicalize() {
        return place;
    }
    match (folder_of(path).canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_path_buf(),
    }
}

#[cfg(unix)]
fn name_of(kind: fs::FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt as _;
    match kind {
        kind if kind.is_fifo() => "a pipe",
        kind if kind.is_socket() => "a socket",
        kind if kind.is_block_device() || kind.is_char_device() => "a device",
        _ => "not a regular file",
    }
}

#[cfg(not(unix))]
fn name_of(_: fs::FileType) -> &'static str {
    "not a regular file"
}
