//! PMTiles directories: the positions of the tiles in the file.

use std::io::Read;

use corniche_varints::varint;
use flate2::read::GzDecoder;

use crate::limits::{MAX_DIRECTORY_BYTES, MAX_DIRECTORY_ENTRIES, MIN_PAYLOAD_BYTES};

/// An entry: with a `run` of 1 the tile `first`; with a `run` of 0 a leaf directory of the tiles
/// from `first` on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct DirectoryEntry {
    pub first: u64,
    pub run: u32,
    /// Offset relative to the start of the data, or of the leaf directories.
    pub offset: u64,
    pub length: u32,
}

/// Entries in ascending order of their tiles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Directory {
    pub entries: Vec<DirectoryEntry>,
}

impl Directory {
    /// Parses a directory as it is stored; `None` if the bytes are not a directory.
    ///
    /// Source: PMTiles version 3 specification, section 4.2: four columns of varints, tile ids as
    /// differences, offset 0 for "right after the entry before".
    ///
    /// Memory: the decompressed bytes, and 24 bytes per entry.
    pub(crate) fn parse(stored: &[u8]) -> Option<Self> {
        let bytes = gunzip(stored, MAX_DIRECTORY_BYTES)?;
        let mut bytes = bytes.as_slice();
        let count = usize::try_from(varint(&mut bytes).ok()?).ok()?;
        // Every entry has four varints of at least one byte each.
        if count > MAX_DIRECTORY_ENTRIES.min(bytes.len() / 4) {
            return None;
        }
        let mut entries = vec![DirectoryEntry { first: 0, run: 0, offset: 0, length: 0 }; count];
        let mut first = 0_u64;
        for (index, entry) in entries.iter_mut().enumerate() {
            let step = varint(&mut bytes).ok()?;
            if index > 0 && step == 0 {
                return None;
            }
            first = first.checked_add(step)?;
            entry.first = first;
        }
        for entry in &mut entries {
            // Each payload contains its tile's id, so no two payloads are equal and a run is never
            // longer than 1. A run of four thousand million tiles would not fit in memory.
            entry.run = u32::try_from(varint(&mut bytes).ok()?).ok().filter(|&run| run <= 1)?;
        }
        for entry in &mut entries {
            let shortest = if entry.run == 0 { 1 } else { MIN_PAYLOAD_BYTES };
            entry.length = u32::try_from(varint(&mut bytes).ok()?)
                .ok()
                .filter(|&length| length >= shortest)?;
        }
        let mut after = None;
        // The end of the last leaf and the end of the last tile.
        let mut ends = [0_u64; 2];
        for entry in &mut entries {
            entry.offset = match varint(&mut bytes).ok()? {
                0 => after?,
                offset => offset - 1,
            };
            // In a clustered file, later tiles have higher offsets. So tiles do not share bytes,
            // and a file cannot list more tiles than it has bytes for.
            let end = &mut ends[entry.run as usize];
            if entry.offset < *end {
                return None;
            }
            *end = entry.offset.checked_add(u64::from(entry.length))?;
            after = Some(*end);
        }
        bytes.is_empty().then_some(Self { entries })
    }

    /// Finds the entry of a tile, or the leaf directory that may contain the tile.
    pub(crate) fn find(&self, order: u64) -> Option<DirectoryEntry> {
        let after = self.entries.partition_point(|entry| entry.first <= order);
        let entry = *self.entries.get(after.checked_sub(1)?)?;
        (entry.run == 0 || order == entry.first).then_some(entry)
    }
}

/// Decompresses gzip of at most `limit` bytes; `None` if it is damaged, incomplete or larger.
pub(crate) fn gunzip(stored: &[u8], limit: usize) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    GzDecoder::new(stored).take(limit as u64 + 1).read_to_end(&mut bytes).ok()?;
    (bytes.len() <= limit).then_some(bytes)
}

#[cfg(test)]
#[path = "directory_tests.rs"]
mod tests;
