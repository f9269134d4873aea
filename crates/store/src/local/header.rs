//! The bytes at the beginning of every file of a store.
//!
//! ```text
//!  0      8        12                                44    48
//!  ┌──────┬────────┬─────────────────────────────────┬─────┐     integers are little-endian
//!  │magic │version │ hash of the plan                │ CRC │     CRC-32 of the 44 bytes before it
//!  └──────┴────────┴─────────────────────────────────┴─────┘
//! ```

use std::path::Path;

use crate::{PlanHash, StoreError};

/// The format version of stores that this program writes, and the only one that it reads.
pub const VERSION: u32 = 1;
/// Number of bytes of a header.
pub(crate) const HEADER_BYTES: u64 = 48;

/// The kind of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FileKind {
    Store,
    Journal,
    Data,
    /// Begins like a data file, because it was one before.
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

    /// Returns the error about a damaged file of this kind: what is wrong, and what to do.
    pub(crate) fn damaged(self, path: &Path, what: &str) -> StoreError {
        let remedy = match self {
            Self::Store => "delete the store and start over (build: with -O)",
            Self::Journal | Self::Data => {
                "delete the file and run the same command again (build: with --resume)"
            }
            Self::Sealed => "delete the file and create the part again",
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

/// Decodes the plan's hash in a header.
///
/// # Errors
/// When the header has another version, is damaged, or is not a header of this kind of file.
pub(crate) fn decode(kind: FileKind, bytes: &[u8], path: &Path) -> Result<PlanHash, StoreError> {
    let damaged = |what| kind.damaged(path, what);
    let Some((bytes, _)) = bytes.split_first_chunk::<{ HEADER_BYTES as usize }>() else {
        return Err(damaged("it is too short"));
    };
    if &bytes[..8] != kind.magic() {
        return Err(damaged("it does not begin with the bytes that mark a file of this kind"));
    }
    let found = u32_at(bytes, 8);
    if found != VERSION {
        // The whole store has another version and may be deleted, so the error names the store.
        let path = match kind {
            FileKind::Store => path.parent().unwrap_or(path),
            FileKind::Journal | FileKind::Data | FileKind::Sealed => path,
        };
        return Err(StoreError::OtherVersion { path: path.to_owned(), found, known: VERSION });
    }
    if u32_at(bytes, 44) != crc32fast::hash(&bytes[..44]) {
        return Err(damaged("the checksum of its header does not match"));
    }
    let mut plan = [0; 32];
    plan.copy_from_slice(&bytes[12..44]);
    Ok(plan)
}

/// Decodes the hash and checks that it is `plan`.
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

/// Reads the integer at a position, which must be within the bytes.
pub(crate) fn u32_at(bytes: &[u8], at: usize) -> u32 {
    let mut word = [0; 4];
    word.copy_from_slice(&bytes[at..at + 4]);
    u32::from_le_bytes(word)
}

/// Reads the integer at a position, which must be within the bytes.
pub(crate) fn u64_at(bytes: &[u8], at: usize) -> u64 {
    let mut word = [0; 8];
    word.copy_from_slice(&bytes[at..at + 8]);
    u64::from_le_bytes(word)
}
