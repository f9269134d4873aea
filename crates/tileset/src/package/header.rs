//! The fixed header of a PMTiles file.

use std::ops::Range;

use crate::limits::{MAX_DIRECTORY_BYTES, MAX_METADATA_BYTES};
use crate::package::error::OpenError;

/// Bytes of the header.
pub(crate) const HEADER_BYTES: usize = 127;
/// Header and root directory lie within the first bytes of the file.
pub(crate) const INITIAL_BYTES: usize = 16_384;

/// Bytes of the file, from and how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Span {
    pub(crate) offset: u64,
    pub(crate) length: u64,
}

/// The bytes of a file that tell which package it is: header, root directory, manifest and leaf directories, of which `start` has the first and
/// `file_length` says how long the file is. `None` if it is no package.
#[must_use]
pub fn telling_ranges(start: &[u8], file_length: u64) -> Option<[Range<u64>; 4]> {
    let Header { root, metadata, leaves, .. } = Header::parse(start, file_length).ok()?;
    let header = Span { offset: 0, length: HEADER_BYTES as u64 };
    // The header was checked: no sum is too large.
    Some([header, root, metadata, leaves].map(|Span { offset, length }| offset..offset + length))
}

/// Some bytes of a header, from one on.
pub(crate) fn bytes_at<const N: usize>(header: &[u8; HEADER_BYTES], from: usize) -> [u8; N] {
    std::array::from_fn(|index| header[from + index])
}

/// What a reader needs of the header.
///
/// ```text
///   0 "PMTiles" 7 version 8 root 24 metadata 40 leaves 56 data (offset, length: u64 each)
///   72 three counts 96 clustered 97 compression of directories, 98 of tiles 99 tile type 100 levels 102 bounds …
/// ```
///
/// Source: PMTiles version 3 specification, section 3.
#[derive(Debug, Clone)]
pub(crate) struct Header {
    pub(crate) root: Span,
    pub(crate) metadata: Span,
    pub(crate) leaves: Span,
    pub(crate) data: Span,
    /// How many tiles there are; 0 where the writer did not know.
    pub(crate) tiles: u64,
}

impl Header {
    /// Reads the header of a file of `file_length` bytes from its first bytes.
    pub(crate) fn parse(bytes: &[u8], file_length: u64) -> Result<Self, OpenError> {
        if !bytes.starts_with(b"PMTiles") {
            return Err(OpenError::NotPmtiles);
        }
        let Some(bytes) = bytes.first_chunk::<HEADER_BYTES>() else {
            return Err(OpenError::Truncated { needed: HEADER_BYTES as u64, actual: file_length });
        };
        if bytes[7] != 3 {
            return Err(OpenError::PmtilesVersion { found: bytes[7] });
        }
        let number = |at: usize| u64::from_le_bytes(bytes_at(bytes, at));
        let span = |at: usize| Span { offset: number(at), length: number(at + 8) };
        let header = Self {
            root: span(8),
            metadata: span(24),
            leaves: span(40),
            data: span(56),
            tiles: number(72),
        };
        let [internal, tiles, kind] = [bytes[97], bytes[98], bytes[99]];
        // 2 is gzip, 1 none; kind 0 is "other".
        if (internal, tiles, kind) != (2, 1, 0) {
            return Err(OpenError::OrdinaryPmtiles);
        }
        let mut spans = [header.root, header.metadata, header.leaves, header.data];
        for Span { offset, length } in spans {
            let end =
                offset.checked_add(length).ok_or(OpenError::Damaged { what: "the header" })?;
            if end > file_length {
                return Err(OpenError::Truncated { needed: end, actual: file_length });
            }
        }
        // The parts must not overlap: a root directory whose bytes are also those of a leaf would hide all other
        // tiles.
        spans.sort_by_key(|span| span.offset);
        let mut end = HEADER_BYTES as u64;
        for Span { offset, length } in spans.into_iter().filter(|span| span.length > 0) {
            if offset < end {
                return Err(OpenError::Damaged { what: "the header: parts of the file overlap" });
            }
            end = offset + length;
        }
        if header.root.length > MAX_DIRECTORY_BYTES as u64
            || header.metadata.length > MAX_METADATA_BYTES as u64
        {
            return Err(OpenError::Damaged {
                what: "the header: root directory or metadata larger than readers accept",
            });
        }
        Ok(header)
    }
}
