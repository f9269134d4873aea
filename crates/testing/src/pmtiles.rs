//! A PMTiles file in pieces, assembled only according to the specification, so that each piece can
//! be invalid by itself.
//!
//! Source: PMTiles version 3 specification.

use std::io::Write as _;

use flate2::{Compression, write::GzEncoder};

/// The length of PMTiles' header.
pub const HEADER_BYTES: usize = 127;

/// An entry of a directory with its encoded numbers: the difference from the tile id before, and
/// the offset plus one.
#[derive(Debug, Clone, Copy)]
#[expect(missing_docs, reason = "the specification's own columns")]
pub struct RawDirectoryEntry {
    pub step: u64,
    pub run: u64,
    pub length: u64,
    pub offset: u64,
}

/// Appends a number with seven bits per byte, the lowest first; all bytes but the last have the
/// highest bit set.
pub fn put_varint(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

/// Returns a directory before compression.
#[must_use]
pub fn directory(entries: &[RawDirectoryEntry]) -> Vec<u8> {
    let mut out = Vec::new();
    put_varint(&mut out, entries.len() as u64);
    let columns: [fn(&RawDirectoryEntry) -> u64; 4] =
        [|e| e.step, |e| e.run, |e| e.length, |e| e.offset];
    for column in columns {
        for entry in entries {
            put_varint(&mut out, column(entry));
        }
    }
    out
}

/// Returns a file of these stored parts (root directory, metadata, leaf directories, tile data),
/// with this number of tiles in its header.
#[must_use]
pub fn file(parts: [&[u8]; 4], tiles: u64) -> Vec<u8> {
    let mut header = b"PMTiles\x03".to_vec();
    let mut offset = HEADER_BYTES;
    for part in parts {
        header.extend((offset as u64).to_le_bytes());
        header.extend((part.len() as u64).to_le_bytes());
        offset += part.len();
    }
    // The numbers of addressed tiles, of entries and of contents.
    [tiles; 3].iter().for_each(|count| header.extend(count.to_le_bytes()));
    // Clustered; gzip for directories and metadata; no compression of tiles; tiles of type "other".
    header.extend([1, 2, 1, 0]);
    header.resize(HEADER_BYTES, 0);
    [&header, parts[0], parts[1], parts[2], parts[3]].concat()
}

/// Compresses bytes with gzip.
#[must_use]
pub fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}
