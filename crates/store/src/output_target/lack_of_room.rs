//! What is lacking if a file cannot be written: disk space, or a larger limit on the size of files.

use std::{
    fmt, fs,
    io::{self, ErrorKind},
    path::Path,
};

/// What is lacking if a file cannot be written. Its text follows the name of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LackOfRoom {
    /// The disk is full, or this user's quota is used up.
    Disk,
    /// The file would be larger than allowed.
    FileSize,
}

impl fmt::Display for LackOfRoom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Disk => "the disk is full; free space, or choose another folder",
            Self::FileSize => {
                "the limit on the size of files is reached (ulimit -f, or the limit of the file system); raise it, or choose another folder"
            }
        })
    }
}

impl LackOfRoom {
    /// Derives the cause from an error of the operating system.
    #[must_use]
    pub fn from_io_error(error: &io::Error) -> Option<Self> {
        match error.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => Some(Self::Disk),
            ErrorKind::FileTooLarge => Some(Self::FileSize),
            _ => None,
        }
    }

    /// Determines the cause for an existing file that a library failed to write, if the library
    /// does not pass on the error.
    #[must_use]
    pub fn at(path: &Path) -> Option<Self> {
        /// A library may fail to write a large block, although a smaller one would fit.
        const AT_ONCE_BYTES: u64 = 1 << 20;
        if free_bytes(path).is_some_and(|free| free < AT_ONCE_BYTES) {
            return Some(Self::Disk);
        }
        let length = fs::metadata(path).map_or(0, |found| found.len());
        let is_near = |limit: u64| length.saturating_add(AT_ONCE_BYTES) >= limit;
        limit_bytes().is_some_and(is_near).then_some(Self::FileSize)
    }

    /// Returns the text that follows the name of the file, if there is any.
    #[must_use]
    pub fn advice(room: Option<Self>) -> String {
        room.map_or_else(String::new, |room| format!(": {room}"))
    }
}

/// The free disk space at a file's location, for this user.
#[cfg(unix)]
fn free_bytes(path: &Path) -> Option<u64> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let found = rustix::fs::statvfs(folder.unwrap_or(Path::new("."))).ok()?;
    Some(found.f_bavail.saturating_mul(found.f_frsize))
}

/// The largest size that a file of this process may have.
#[cfg(unix)]
fn limit_bytes() -> Option<u64> {
    rustix::process::getrlimit(rustix::process::Resource::Fsize).current
}

#[cfg(not(unix))]
fn free_bytes(_: &Path) -> Option<u64> {
    None
}

#[cfg(not(unix))]
fn limit_bytes() -> Option<u64> {
    None
}

#[cfg(test)]
#[path = "lack_of_room_tests.rs"]
mod tests;
