//! What is lacking where a file cannot be written: the disk's room, or a larger limit on the size of files.

use std::{
    fmt, fs,
    io::{self, ErrorKind},
    path::Path,
};

/// What is lacking where a file cannot be written. Its text goes behind what was not written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LackOfRoom {
    /// The disk is full, or this user's share of it.
    Disk,
    /// Files may not be as large.
    FileSize,
}

impl fmt::Display for LackOfRoom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Disk => "the disk is full; free space, or choose another folder",
            Self::FileSize => {
                "files may not be so large here (ulimit -f, or the file system's own limit); raise the limit, or choose another folder"
            }
        })
    }
}

impl LackOfRoom {
    /// What an error of the system says.
    #[must_use]
    pub fn of(error: &io::Error) -> Option<Self> {
        match error.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => Some(Self::Disk),
            ErrorKind::FileTooLarge => Some(Self::FileSize),
            _ => None,
        }
    }

    /// What the system says of a file that a library failed to write and still has, where the library keeps the error to itself.
    #[must_use]
    pub fn at(path: &Path) -> Option<Self> {
        /// What a library writes at once may have no room although less would have.
        const AT_ONCE_BYTES: u64 = 1 << 20;
        if free_bytes(path).is_some_and(|free| free < AT_ONCE_BYTES) {
            return Some(Self::Disk);
        }
        let length = fs::metadata(path).map_or(0, |found| found.len());
        let is_near = |limit: u64| length.saturating_add(AT_ONCE_BYTES) >= limit;
        limit_bytes().is_some_and(is_near).then_some(Self::FileSize)
    }

    /// The text behind what could not be written, if there is one.
    #[must_use]
    pub fn advice(room: Option<Self>) -> String {
        room.map_or_else(String::new, |room| format!(": {room}"))
    }
}

/// The room that is left where a file lies, for this user.
#[cfg(unix)]
fn free_bytes(path: &Path) -> Option<u64> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let found = rustix::fs::statvfs(folder.unwrap_or(Path::new("."))).ok()?;
    Some(found.f_bavail.saturating_mul(found.f_frsize))
}

/// How large a file of this process may become.
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
