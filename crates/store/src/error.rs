//! Errors of storing and reading artifacts, with advice if there is a remedy.

use std::{io, path::PathBuf};

use crate::LackOfRoom;

/// Why an artifact could not be stored or read.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum StoreError {
    #[error("cannot {doing} {path:?}{}", advice(.source))]
    Io { path: PathBuf, doing: &'static str, source: io::Error },
    #[error("{path:?} is damaged: {what}")]
    Damaged { path: PathBuf, what: String },
    #[error(
        "{path:?} was written by another version of Corniche (store format {found}, this version reads {known}); \
         use that version, or delete the store and start over (build: with -O)"
    )]
    OtherVersion { path: PathBuf, found: u32, known: u32 },
    #[error("{path:?} is not empty and not a store of Corniche ({what}); choose another folder")]
    NotAStore { path: PathBuf, what: String },
    #[error("{path:?} contains no store; check the path (a finished build removes its store)")]
    NoStore { path: PathBuf },
    #[error(
        "{path:?} already contains a store; resume from it (build: with --resume), or delete it and start over (build: with -O)"
    )]
    Exists { path: PathBuf },
    #[error("{path:?} belongs to another plan: an input or a setting differs")]
    OtherPlan { path: PathBuf },
    #[error("{path:?} is in use by {owner}; wait until that process has ended")]
    Locked { path: PathBuf, owner: String },
    #[error("{path:?} was deleted or replaced while it was in use; start over")]
    Gone { path: PathBuf },
    #[error("{path:?}: nothing more can be stored, because of an earlier error: {cause}")]
    Failed { path: PathBuf, cause: String },
    #[error("{path:?} is open read-only")]
    ReadOnly { path: PathBuf },
    #[error(
        "artifact {item} of kind {kind} differs between {first:?} and {second:?}, although both belong to the same plan; \
         delete the wrong one"
    )]
    Differs { kind: u8, item: u64, first: PathBuf, second: PathBuf },
    #[error("{path:?} cannot store {what}: {length} is more than the limit of {limit}")]
    TooLarge { path: PathBuf, what: &'static str, length: u64, limit: u64 },
    #[error("{name:?} is not a valid name of a part; use letters, digits, '-' and '_'")]
    PartName { name: String },
    #[error("{what}")]
    Place { what: String, is_unusable: bool },
}

impl StoreError {
    /// Whether the caller's input cannot be used (a name, an address, credentials, a store of
    /// another version or plan), as opposed to a failure.
    #[must_use]
    pub fn is_unusable(&self) -> bool {
        matches!(
            self,
            Self::Place { is_unusable: true, .. }
                | Self::OtherVersion { .. }
                | Self::OtherPlan { .. }
        )
    }
}

/// Returns advice for errors that have a remedy. Every command with a store prints these texts, so
/// options of a single command are given with its name.
fn advice(source: &io::Error) -> &'static str {
    if is_too_many_open_files(source) {
        return ": too many files are open, and each part of a store is an open file; raise the limit (ulimit -n) or create parts of \
                larger subtrees, then run the same command again";
    }
    match LackOfRoom::from_io_error(source) {
        Some(LackOfRoom::Disk) => {
            return ": the disk is full; free space and run the same command again (build: with --resume), or choose another folder \
             (build: with --tmp)";
        }
        Some(LackOfRoom::FileSize) => {
            return ": the limit on the size of files is reached (ulimit -f, or the limit of the file system); raise it, or choose another \
             folder (build: with --tmp), then run the same command again (build: with --resume)";
        }
        None => {}
    }
    match source.kind() {
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            ": no permission; choose another folder (build: with --tmp)"
        }
        io::ErrorKind::Unsupported => {
            ": this file system does not support it; choose another folder (build: with --tmp)"
        }
        _ => "",
    }
}

/// Whether the limit of open files of the process (`EMFILE`) or of the machine (`ENFILE`) is
/// reached. All Unix systems have the same numbers.
fn is_too_many_open_files(source: &io::Error) -> bool {
    cfg!(unix) && matches!(source.raw_os_error(), Some(23 | 24))
}

impl From<StoreError> for io::Error {
    /// Converts the error for users of [`ScratchSpace`](crate::ScratchSpace), whose errors pass
    /// through readers and writers. The kind is preserved.
    fn from(error: StoreError) -> Self {
        let kind = match &error {
            StoreError::Io { source, .. } => source.kind(),
            _ => io::ErrorKind::Other,
        };
        Self::new(kind, error)
    }
}

#[cfg(test)]
#[path = "error_tests.rs"]
mod tests;
