//! The fixed header of a PMTiles file.

use std::ops::Range;

use crate::{
    limits::{MAX_DIRECTORY_BYTES, MAX_METADATA_BYTES},
    package::error::OpenError,
};

/// Number of bytes of the header.
pub(crate) const HEADER_BYTES: usize = 127;
/// Header and root directory are within the first bytes of the file.
pub(crate) const INITIAL_BYTES: usize = 16_384;

/// A range of bytes of the file: offset and length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ByteSpan {
    pub offset: u64,
    pub length: u64,
}

/// The ranges of a file that identify a package: header, root directory, manifest and leaf
/// directories. `start` holds the first bytes of the file, and `file_length` is the length of the
/// whole file. Returns `None` if the file is not a package.
#[must_use]
pub fn telling_ranges(start: &[u8], file_length: u64) -> Option<[Range<u64>; 4]> {
    let PackageHeader { root, metadata, leaves, .. } =
        PackageHeader::parse(start, file_length).ok()?;
    let header = ByteSpan { offset: 0, length: HEADER_BYTES as u64 };
    // The header was checked, so no sum overflows.
    Some(
        [header, root, metadata, leaves].map(|ByteSpan { offset, length }| offset..offset + length),
    )
}

/// Returns some bytes of a header, beginning at `from`.
pub(crate) fn bytes_at<const N: usize>(header: &[u8; HEADER_BYTES], from: usize) -> [u8; N] {
    std::array::from_fn(|index| header[from + index])
}

/// The fields of the header that a reader needs.
///
/// ```text
///   0 "PMTiles" 7 version 8 root 24 metadata 40 leaves 56 data (offset, length: u64 each)
///   72 three counts 96 clustered 97 compression of directories, 98 of tiles 99 tile type 100 levels 102 bounds …
/// ```
///
/// Source: PMTiles version 3 specification, section 3.
#[derive(Debug, Clone)]
pub(crate) struct PackageHeader {
    pub root: ByteSpan,
    pub metadata: ByteSpan,
    pub leaves: ByteSpan,
    pub data: ByteSpan,
    /// Number of tiles; 0 if the writer did not know it.
    pub tiles: u64,
}

impl PackageHeader {
    /// Parses the header of a file of `file_length` bytes from its first bytes.
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
        let span = |at: usize| ByteSpan { offset: number(at), length: number(at + 8) };
        let header = Self {
            root: span(8),
            metadata: span(24),
            leaves: span(40),
            data: span(56),
            tiles: number(72),
        };
        let [internal, tiles, kind] = [bytes[97], bytes[98], bytes[99]];
        // 2 is gzip, 1 is none; tile type 0 is "other".
        if (internal, tiles, kind) != (2, 1, 0) {
            return Err(OpenError::OrdinaryPmtiles);
        }
        let mut spans = [header.root, header.metadata, header.leaves, header.data];
        for ByteSpan { offset, length } in spans {
            let end =
                offset.checked_add(length).ok_or(OpenError::Damaged { what: "the header" })?;
            if end > file_length {
                return Err(OpenError::Truncated { needed: end, actual: file_length });
            }
        }
        // The parts must not overlap: a root directory whose bytes also belong to a leaf would hide
        // all other tiles.
        spans.sort_by_key(|span| span.offset);
        let mut end = HEADER_BYTES as u64;
        for ByteSpan { offset, length } in spans.into_iter().filter(|span| span.length > 0) {
            if offset < end {
                return Err(OpenError::Damaged { what: "the header: parts of the file overlap" });
            }
            end = offset + length;
        }
        if header.root.length > MAX_DIRECTORY_BYTES as u64
            || header.metadata.length > MAX_METADATA_BYTES as u64
        {
            return Err(OpenError::Damaged {
                what: "the header: the root directory or the metadata is larger than readers accept",
            });
        }
        Ok(header)
    }
}
