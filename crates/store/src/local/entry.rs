//! The entry of an artifact: in a journal in the order of storing, at the end of a sealed part by
//! key.
//!
//! ```text
//!  0        8        16       20     24     25      28    32
//!  ┌────────┬────────┬────────┬──────┬──────┬───────┬─────┐     integers are little-endian
//!  │ item   │ offset │ length │ CRC  │ kind │ zeros │check│     CRC: CRC-32 of the artifact
//!  └────────┴────────┴────────┴──────┴──────┴───────┴─────┘     check: CRC-32 of the entry's number (8 bytes) and the 28 before
//! ```
//!
//! The check includes the number, so that an intact entry in another position is not mistaken for a
//! valid one.

use std::path::Path;

use crate::{
    ArtifactKey, StoreError,
    local::{
        header::{HEADER_BYTES, u32_at, u64_at},
        index::OFFSET_LIMIT,
    },
};

/// Number of bytes of an entry.
pub(crate) const ENTRY_BYTES: usize = 32;

/// The position of an artifact in its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ArtifactEntry {
    pub key: ArtifactKey,
    pub offset: u64,
    pub length: u32,
    /// The CRC-32 of the artifact.
    pub crc: u32,
}

/// Called for each entry of a part, with the file that contains it, so that the list need not be in
/// memory twice.
pub(crate) type Visit<'a> = dyn FnMut(&Path, ArtifactEntry) -> Result<(), StoreError> + 'a;

impl ArtifactEntry {
    pub(crate) fn encode(&self, number: u64) -> [u8; ENTRY_BYTES] {
        let mut bytes = [0; ENTRY_BYTES];
        bytes[..8].copy_from_slice(&self.key.item.to_le_bytes());
        bytes[8..16].copy_from_slice(&self.offset.to_le_bytes());
        bytes[16..20].copy_from_slice(&self.length.to_le_bytes());
        bytes[20..24].copy_from_slice(&self.crc.to_le_bytes());
        bytes[24] = self.key.kind;
        let check = check(number, &bytes[..28]);
        bytes[28..].copy_from_slice(&check.to_le_bytes());
        bytes
    }

    /// Decodes the entry of this number; `None` if the bytes are not that entry, or if its artifact
    /// is not within a file whose artifacts end at `end`.
    pub(crate) fn decode(number: u64, bytes: &[u8], end: u64) -> Option<Self> {
        if bytes.len() != ENTRY_BYTES || u32_at(bytes, 28) != check(number, &bytes[..28]) {
            return None;
        }
        let entry = Self {
            key: ArtifactKey { kind: bytes[24], item: u64_at(bytes, 0) },
            offset: u64_at(bytes, 8),
            length: u32_at(bytes, 16),
            crc: u32_at(bytes, 20),
        };
        let fits = entry.offset >= HEADER_BYTES
            && entry.offset < OFFSET_LIMIT
            && entry.end().is_some_and(|own_end| own_end <= end);
        fits.then_some(entry)
    }

    /// The end of the artifact.
    pub(crate) fn end(&self) -> Option<u64> {
        self.offset.checked_add(u64::from(self.length))
    }
}

fn check(number: u64, bytes: &[u8]) -> u32 {
    let mut crc = crc32fast::Hasher::new();
    crc.update(&number.to_le_bytes());
    crc.update(bytes);
    crc.finalize()
}
