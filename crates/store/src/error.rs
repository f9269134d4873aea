//! Errors of keeping and reading back, with advice where there is a remedy.

use std::{io, path::PathBuf};

use crate::LackOfRoom;

/// Why something could not be kept or read back.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum StoreError {
    #[error("cannot {doing} {path:?}{}", advice(.source))]
    Io { path: PathBuf, doing: &'static str, source: io::Error },
    #[error("{path:?} is damaged: {what}")]
    Damaged { path: PathBuf, what: String },
    #[error(
        "{path:?} was written by another version of Corniche (store format {found}, this one knows {known}); \
         use that version, or remove it and start again (build: with -O)"
    )]
    OtherVersion { path: PathBuf, found: u32, known: u32 },
    #[error("{path:?} is not a store of Corniche and not empty ({what}); choose another folder")]
    NotAStore { path: PathBuf, what: String },
    #[error("{path:?} holds no store; nothing was begun here, or it is done")]
    NoStore { path: PathBuf },
    #[error(
        "{path:?} already holds a store; go on from it (build: with --resume), or remove it and start again (build: with -O)"
    )]
    Exists { path: PathBuf },
    #[error("{path:?} belongs to another plan: an input or a setting differs")]
    OtherPlan { path: PathBuf },
    #[error("{path:?} is in use by {owner}; wait until it has ended")]
    Locked { path: PathBuf, owner: String },
    #[error("{path:?} was removed or replaced while it was in use; start again")]
    Gone { path: PathBuf },
    #[error("{path:?}: nothing more can be kept, because earlier: {cause}")]
    Failed { path: PathBuf, cause: String },
    #[error("{path:?} is open for reading only")]
    ReadOnly { path: PathBuf },
    #[error(
        "artifact {item} of kind {kind} is not the same in {first:?} and {second:?}, although both belong to one plan; \
         remove the wrong one"
    )]
    Differs { kind: u8, item: u64, first: PathBuf, second: PathBuf },
    #[error("{path:?} cannot keep {what}: {length} where at most {limit} are possible")]
    TooLarge { path: PathBuf, what: &'static str, length: u64, limit: u64 },
    #[error("{name:?} cannot be the name of a part: use letters, digits, '-' and '_'")]
    PartName { name: String },
    #[error("{what}")]
    Place { what: String, is_unusable: bool },
}

impl StoreError {
    /// Whether what was given cannot be used (a name, an address, credentials, a store of another version or plan), rather than that something
    /// failed.
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

/// What to do about a cause that has a remedy. Every command with a store says this, so options of one command are told with its name.
fn advice(source: &io::Error) -> &'static str {
    if is_too_many_open_files(source) {
        return ": too many files are open, and each part of a store is one; allow more (ulimit -n) or make parts of larger \
                subtrees, then run the same command again";
    }
    match LackOfRoom::of(source) {
        Some(LackOfRoom::Disk) => {
            return ": the disk is full; free space and run the same command again (build: with --resume), or choose another folder \
             (build: with --tmp)";
        }
        Some(LackOfRoom::FileSize) => {
            return ": a limit on the size of files is reached (ulimit -f, or the file system's own); raise it, or choose another folder (build: \
             with --tmp), then run the same command again (build: with --resume)";
        }
        None => {}
    }
    match source.kind() {
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            ": no permission; choose another folder (build: with --tmp)"
        }
        io::ErrorKind::Unsupported => {
            ": this file system cannot do it; choose another folder (build: with --tmp)"
        }
        _ => "",
    }
}

/// Whether the limit of open files is reached, of the process (`EMFILE`) or of the machine (`ENFILE`). All Unix systems have the same numbers.
fn is_too_many_open_files(source: &io::Error) -> bool {
    cfg!(unix) && matches!(source.raw_os_error(), Some(23 | 24))
}

impl From<StoreError> for io::Error {
    /// The error for users of [`Scratch`](crate::Scratch), whose errors travel through readers and writers. The kind stays.
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
