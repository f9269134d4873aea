//! A package in pieces, put together from the specifications alone, so that each piece can be wrong by itself.

use crate::common;

/// PMTiles' header counts so many bytes.
pub(crate) const HEADER_BYTES: usize = 127;

/// One entry of a directory, in the numbers that are written: steps of tile ids, and offsets plus one.
pub(crate) struct Entry {
    pub(crate) step: u64,
    pub(crate) run: u64,
    pub(crate) length: u64,
    pub(crate) offset: u64,
}

pub(crate) fn varint(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

/// A directory before compression.
pub(crate) fn directory(entries: &[Entry]) -> Vec<u8> {
    let mut out = Vec::new();
    varint(&mut out, entries.len() as u64);
    let columns: [fn(&Entry) -> u64; 4] = [|e| e.step, |e| e.run, |e| e.length, |e| e.offset];
    for column in columns {
        for entry in entries {
            varint(&mut out, column(entry));
        }
    }
    out
}

/// The pieces of a file, as they are stored.
pub(crate) struct Parts {
    pub(crate) root: Vec<u8>,
    pub(crate) metadata: Vec<u8>,
    pub(crate) leaves: Vec<u8>,
    pub(crate) data: Vec<u8>,
    /// Tiles that the header speaks of.
    pub(crate) tiles: u64,
}

impl Parts {
    /// The good package: four tiles, root directory alone.
    pub(crate) fn good() -> Self {
        let tiles: Vec<Vec<u8>> = common::ids().into_iter().map(common::encoded).collect();
        Self::of_tiles(&tiles)
    }

    /// Payloads in the places of the good package's first tiles.
    pub(crate) fn of_tiles(tiles: &[Vec<u8>]) -> Self {
        let mut entries = Vec::new();
        let (mut last, mut offset) = (0, 1);
        for (id, tile) in common::ids().into_iter().zip(tiles) {
            let order = corniche_tileset::pmtiles_order(id);
            let length = tile.len() as u64;
            entries.push(Entry { step: order - last, run: 1, length, offset });
            (last, offset) = (order, offset + length);
        }
        Self {
            root: common::gzip(&directory(&entries)),
            metadata: common::gzip(metadata().to_string().as_bytes()),
            leaves: Vec::new(),
            tiles: tiles.len() as u64,
            data: tiles.concat(),
        }
    }

    /// The file.
    pub(crate) fn assemble(&self) -> Vec<u8> {
        let mut header = b"PMTiles\x03".to_vec();
        let mut offset = HEADER_BYTES;
        for part in [&self.root, &self.metadata, &self.leaves, &self.data] {
            header.extend((offset as u64).to_le_bytes());
            header.extend((part.len() as u64).to_le_bytes());
            offset += part.len();
        }
        [self.tiles; 3].iter().for_each(|count| header.extend(count.to_le_bytes()));
        // Clustered, gzip, no compression of tiles, "other".
        header.extend([1, 2, 1, 0]);
        header.resize(HEADER_BYTES, 0);
        [&header, &self.root, &self.metadata, &self.leaves, &self.data].map(Vec::as_slice).concat()
    }

    /// The file with other bytes at a place of its header.
    pub(crate) fn with_header(&self, at: usize, bytes: &[u8]) -> Vec<u8> {
        let mut file = self.assemble();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    }
}

/// The good package's metadata.
pub(crate) fn metadata() -> serde_json::Value {
    let manifest = serde_json::to_value(common::manifest()).unwrap();
    serde_json::json!({ "name": "test", "corniche": manifest })
}

/// A section as it is stored.
pub(crate) struct Section {
    pub(crate) kind: u16,
    pub(crate) compression: u8,
    pub(crate) raw_length: u32,
    pub(crate) stored: Vec<u8>,
}

impl Section {
    /// Without compression.
    pub(crate) fn plain(kind: u16, raw: Vec<u8>) -> Self {
        Self { kind, compression: 0, raw_length: raw.len() as u32, stored: raw }
    }

    /// One zstd frame.
    pub(crate) fn zstd(kind: u16, raw: &[u8]) -> Self {
        let stored = zstd::bulk::compress(raw, 3).unwrap();
        Self { kind, compression: 1, raw_length: raw.len() as u32, stored }
    }
}

/// A payload of tile 0/0/0 with right offsets and checksums.
pub(crate) fn payload(sections: &[Section]) -> Vec<u8> {
    let mut bytes = b"CRNT\0\0".to_vec();
    bytes.extend([sections.len() as u8, 0]);
    bytes.extend([0; 8]);
    let mut offset = 16 + 20 * sections.len() + 4;
    for section in sections {
        bytes.extend(section.kind.to_le_bytes());
        bytes.extend([section.compression, 0]);
        let checksum = crc32fast::hash(&section.stored);
        for number in [offset as u32, section.stored.len() as u32, section.raw_length, checksum] {
            bytes.extend(number.to_le_bytes());
        }
        offset += section.stored.len();
    }
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    for section in sections {
        bytes.extend(&section.stored);
    }
    bytes
}

/// A payload with other bytes at a place of its header or section table, and a checksum that fits.
pub(crate) fn resealed(mut payload: Vec<u8>, at: usize, bytes: &[u8]) -> Vec<u8> {
    let end = 16 + 20 * usize::from(payload[6]);
    payload[at..at + bytes.len()].copy_from_slice(bytes);
    let sum = crc32fast::hash(&payload[..end]);
    payload[end..end + 4].copy_from_slice(&sum.to_le_bytes());
    payload
}

/// The sections of the good package's tile 0/0/0, decompressed by zstd's own decoder, in the order of their kinds.
pub(crate) fn raw_sections() -> Vec<Vec<u8>> {
    let bytes = common::encoded("0/0/0".parse().unwrap());
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    (0..usize::from(bytes[6]))
        .map(|entry| {
            let at = 16 + 20 * entry;
            let stored = &bytes[number(at + 4)..number(at + 4) + number(at + 8)];
            match bytes[at + 2] {
                0 => stored.to_vec(),
                _ => zstd::bulk::decompress(stored, number(at + 12)).unwrap(),
            }
        })
        .collect()
}
