//! The bytes that every file of a store begins with.
//!
//! ```text
//!  0      8        12                                44    48
//!  ┌──────┬────────┬─────────────────────────────────┬─────┐     integers are little-endian
//!  │magic │version │ hash of the plan                │ CRC │     CRC-32 of the 44 bytes before it
//!  └──────┴────────┴─────────────────────────────────┴─────┘
//! ```

use std::path::Path;

use crate::{PlanHash, StoreError};

/// The format of stores that this version writes, and the only one that it reads.
pub const VERSION: u32 = 1;
/// Bytes of a header.
pub(crate) const HEADER_BYTES: u64 = 48;

/// What a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FileKind {
    Store,
    Journal,
    Data,
    /// Begins as data does: it was data before.
    Sealed,
}

impl FileKind {
    fn magic(self) -> &'static [u8; 8] {
        match self {
            Self::Store => b"CORNSTOR",
            Self::Journal => b"CORNJOUR",
            Self::Data | Self::Sealed => b"CORNDATA",
        }
    }

    /// The error about such a file that is damaged: what is wrong, and what to do.
    pub(crate) fn damaged(self, path: &Path, what: &str) -> StoreError {
        let remedy = match self {
            Self::Store => "remove the store and start again (build: with -O)",
            Self::Journal | Self::Data => {
                "remove the file and run the same command again (build: with --resume)"
            }
            Self::Sealed => "remove the file and make the part again",
        };
        StoreError::Damaged { path: path.to_owned(), what: format!("{what}; {remedy}") }
    }
}

pub(crate) fn encode(kind: FileKind, plan: &PlanHash) -> [u8; HEADER_BYTES as usize] {
    let mut bytes = [0; HEADER_BYTES as usize];
    bytes[..8].copy_from_slice(kind.magic());
    bytes[8..12].copy_from_slice(&VERSION.to_le_bytes());
    bytes[12..44].copy_from_slice(plan);
    let crc = crc32fast::hash(&bytes[..44]);
    bytes[44..].copy_from_slice(&crc.to_le_bytes());
    bytes
}

/// Whether bytes are a header of this kind of file, of any version.
pub(crate) fn begins_as(kind: FileKind, bytes: &[u8]) -> bool {
    bytes.len() as u64 >= HEADER_BYTES && bytes.starts_with(kind.magic())
}

/// The plan's hash in a header.
///
/// # Errors
/// Where it is of another version, damaged, or no header of this kind of file.
pub(crate) fn decode(kind: FileKind, bytes: &[u8], path: &Path) -> Result<PlanHash, StoreError> {
    let damaged = |what| kind.damaged(path, what);
    let Some((bytes, _)) = bytes.split_first_chunk::<{ HEADER_BYTES as usize }>() else {
        return Err(damaged("it is too short"));
    };
    if &bytes[..8] != kind.magic() {
        return Err(damaged("it does not begin as such a file begins"));
    }
    let found = u32_at(bytes, 8);
    if found != VERSION {
        // What is of another version, and may be removed, is the whole store.
        let path = match kind {
            FileKind::Store => path.parent().unwrap_or(path),
            FileKind::Journal | FileKind::Data | FileKind::Sealed => path,
        };
        return Err(StoreError::OtherVersion { path: path.to_owned(), found, known: VERSION });
    }
    if u32_at(bytes, 44) != crc32fast::hash(&bytes[..44]) {
        return Err(damaged("the checksum of its header is wrong"));
    }
    let mut plan = [0; 32];
    plan.copy_from_slice(&bytes[12..44]);
    Ok(plan)
}

/// Does the same as `decode`, and the hash must be `plan`.
pub(crate) fn check(
    kind: FileKind,
    bytes: &[u8],
    path: &Path,
    plan: &PlanHash,
) -> Result<(), StoreError> {
    if decode(kind, bytes, path)? == *plan {
        Ok(())
    } else {
        Err(StoreError::OtherPlan { path: path.to_owned() })
    }
}

/// The integer at a place that is there.
pub(crate) fn u32_at(bytes: &[u8], at: usize) -> u32 {
    let mut word = [0; 4];
    word.copy_from_slice(&bytes[at..at + 4]);
    u32::from_le_bytes(word)
}

/// The integer at a place that is there.
pub(crate) fn u64_at(bytes: &[u8], at: usize) -> u64 {
    let mut word = [0; 8];
    word.copy_from_slice(&bytes[at..at + 8]);
    u64::from_le_bytes(word)
}
