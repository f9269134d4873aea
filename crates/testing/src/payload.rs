//! A tile's payload assembled only according to `crates/tileset/FORMAT.md`, so that each part can
//! be invalid by itself.

use corniche_geom::TileId;

/// Number of bytes before the section table.
const HEADER_BYTES: usize = 16;
/// Number of bytes of an entry of the section table.
const ENTRY_BYTES: usize = 20;

/// A section as it is stored.
#[derive(Debug, Clone)]
#[expect(missing_docs, reason = "FORMAT.md's own fields")]
pub struct RawSection {
    pub kind: u16,
    /// 0 is none; 1 is one zstd frame.
    pub compression: u8,
    pub raw_length: u32,
    pub stored: Vec<u8>,
}

impl RawSection {
    /// Returns a section without compression.
    #[must_use]
    pub fn plain(kind: u16, raw: Vec<u8>) -> Self {
        Self { kind, compression: 0, raw_length: raw.len() as u32, stored: raw }
    }
}

/// Returns a payload with correct offsets and checksums, of at most 255 sections.
#[must_use]
pub fn payload(id: TileId, sections: &[RawSection]) -> Vec<u8> {
    let mut bytes = b"CRNT\x02\0".to_vec();
    bytes.extend([sections.len() as u8, id.z()]);
    bytes.extend(id.x().to_le_bytes());
    bytes.extend(id.y().to_le_bytes());
    let mut offset = table_end(&bytes) + 4;
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

/// Corrects the checksum of a payload's header and section table, if the payload is long enough to
/// have one.
#[must_use]
pub fn with_right_table_checksum(mut payload: Vec<u8>) -> Vec<u8> {
    if payload.len() < HEADER_BYTES {
        return payload;
    }
    let end = table_end(&payload);
    let Some(sum) = payload.get(..end).map(crc32fast::hash) else { return payload };
    if let Some(slot) = payload.get_mut(end..end + 4) {
        slot.copy_from_slice(&sum.to_le_bytes());
    }
    payload
}

/// Corrects the checksums of a payload's sections and of its table, as far as the table is usable.
#[must_use]
pub fn with_right_checksums(mut payload: Vec<u8>) -> Vec<u8> {
    if payload.len() < HEADER_BYTES {
        return payload;
    }
    for entry in (HEADER_BYTES..table_end(&payload)).step_by(ENTRY_BYTES) {
        let number = |at: usize| {
            let four = payload.get(at..)?.first_chunk()?;
            Some(u32::from_le_bytes(*four) as usize)
        };
        let range = number(entry + 4).zip(number(entry + 8));
        let range = range.and_then(|(from, length)| Some(from..from.checked_add(length)?));
        let Some(section) = range.and_then(|range| payload.get(range)) else { continue };
        let sum = crc32fast::hash(section).to_le_bytes();
        if let Some(slot) = payload.get_mut(entry + 16..entry + 20) {
            slot.copy_from_slice(&sum);
        }
    }
    with_right_table_checksum(payload)
}

/// The end of the section table, according to the number of sections in the header.
fn table_end(payload: &[u8]) -> usize {
    HEADER_BYTES + ENTRY_BYTES * usize::from(payload[6])
}
