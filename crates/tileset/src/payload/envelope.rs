//! Header, section table and sections of a payload, without the content of sections.

use std::io::Read;

use corniche_geom::TileId;
use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

use crate::{
    limits::MAX_SECTION_BYTES,
    payload::{
        damage::{Damage, DecodeError, Result},
        number_codes::Cursor,
        section_kind::{SectionKind, TwoKinds},
    },
};

/// The first bytes of every payload: "Corniche Tile".
pub(crate) const MAGIC: [u8; 4] = *b"CRNT";
/// Version of the payload's layout.
pub(crate) const VERSION: u16 = 2;
/// The section is stored without compression.
pub(crate) const STORED: u8 = 0;
/// The section is stored as one zstd frame.
pub(crate) const ZSTD: u8 = 1;

/// A section as it is stored in the payload.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StoredSection<'a> {
    kind: u16,
    pub compression: u8,
    pub raw_length: u32,
    pub checksum: u32,
    /// The stored length of the section in a complete payload.
    stored_length: usize,
    /// The stored bytes; empty if the payload was read without its last section.
    pub bytes: &'a [u8],
}

impl StoredSection<'_> {
    /// The kind of the section, if this version knows it.
    pub(crate) fn known_kind(&self) -> Option<SectionKind> {
        SectionKind::from_number(self.kind)
    }

    /// Whether the bytes of the section were read.
    fn is_read(&self) -> bool {
        self.bytes.len() == self.stored_length
    }
}

/// Splits a complete payload into sections. Their content is not inspected yet; they are contiguous
/// up to the payload's last byte, so that each byte is covered by one checksum.
pub(crate) fn open(bytes: &[u8], id: TileId) -> Result<Vec<StoredSection<'_>>> {
    let sections = open_read(bytes, id)?;
    if sections.iter().all(StoredSection::is_read) { Ok(sections) } else { Err(Damage::TooShort) }
}

/// Splits a payload that may have been read without the SV roads at its end.
pub(crate) fn open_read(bytes: &[u8], id: TileId) -> Result<Vec<StoredSection<'_>>> {
    let mut cursor = Cursor::new(bytes);
    if cursor.array::<4>()? != MAGIC {
        return Err(Damage::Magic);
    }
    let version = u16::from_le_bytes(cursor.array()?);
    if version != VERSION {
        return Err(Damage::Version { found: version, supported: VERSION });
    }
    let [count, z] = cursor.array()?;
    let (x, y) = (u32::from_le_bytes(cursor.array()?), u32::from_le_bytes(cursor.array()?));
    let mut sections: Vec<StoredSection<'_>> = Vec::with_capacity(usize::from(count));
    let mut ends = Vec::with_capacity(usize::from(count));
    for _ in 0..count {
        let kind = u16::from_le_bytes(cursor.array()?);
        let [compression, reserved] = cursor.array()?;
        let [offset, length, raw_length, checksum] =
            [(); 4].map(|()| cursor.array().map(u32::from_le_bytes));
        let (offset, stored_length) = (offset? as usize, length? as usize);
        let stored = offset.checked_add(stored_length).and_then(|end| bytes.get(offset..end));
        Damage::invalid_if(reserved != 0, "a reserved byte of the section table is not 0")?;
        let section = StoredSection {
            kind,
            compression,
            raw_length: raw_length?,
            checksum: checksum?,
            stored_length,
            bytes: stored.unwrap_or_default(),
        };
        let is_last = sections.len() + 1 == usize::from(count);
        let may_be_missing = is_last && section.known_kind().is_some_and(SectionKind::is_sv);
        if stored.is_none() && !(may_be_missing && offset == bytes.len()) {
            return Err(Damage::TooShort);
        }
        ends.push([offset, offset + section.bytes.len()]);
        sections.push(section);
    }
    let table = &bytes[..bytes.len() - cursor.left()];
    if u32::from_le_bytes(cursor.array()?) != crc32fast::hash(table) {
        return Err(Damage::Checksum);
    }
    let mut end = bytes.len() - cursor.left();
    for [from, to] in ends {
        Damage::invalid_if(from != end, "sections are not contiguous")?;
        end = to;
    }
    Damage::invalid_if(end != bytes.len(), "bytes after the last section")?;
    for (number, section) in sections.iter().enumerate() {
        Damage::invalid_if(
            sections[..number].iter().any(|before| before.kind == section.kind),
            "two sections of one kind",
        )?;
    }
    // This check comes after the checksum, so its error means a payload in the position of another
    // tile, not a flipped bit.
    if (z, x, y) != (id.z(), id.x(), id.y()) {
        return Err(Damage::OtherTile { found: format!("{z}/{x}/{y}") });
    }
    Ok(sections)
}

/// Returns the bytes of the section of one kind, decompressed and checked; `None` if it is absent.
pub(crate) fn section(
    sections: &[StoredSection<'_>],
    kind: SectionKind,
) -> Result<Option<Vec<u8>>> {
    let Some(section) = find(sections, kind) else { return Ok(None) };
    if !section.is_read() {
        return Err(Damage::TooShort);
    }
    let raw_length = section.raw_length as usize;
    Damage::limit("length of a section", raw_length as u64, MAX_SECTION_BYTES)?;
    if crc32fast::hash(section.bytes) != section.checksum {
        return Err(Damage::Checksum);
    }
    match section.compression {
        STORED if section.bytes.len() == raw_length => Ok(Some(section.bytes.to_vec())),
        STORED => Err(Damage::Invalid("the length of an uncompressed section")),
        // Writers only compress a section if this makes it smaller.
        ZSTD if section.bytes.len() < raw_length => decompress(section.bytes, raw_length).map(Some),
        ZSTD => Err(Damage::Invalid("the length of a compressed section")),
        _ => Err(Damage::Invalid("an unknown compression")),
    }
}

/// Reads a section separately from the bytes of a payload; errors name the tile and the section.
pub(crate) fn read_part<T>(
    bytes: &[u8],
    tile: TileId,
    kind: SectionKind,
    read: impl FnOnce(&[StoredSection<'_>]) -> Result<T>,
) -> Result<T, DecodeError> {
    let sections = open_read(bytes, tile).map_err(|damage| damage.in_header(tile))?;
    read(&sections).map_err(kind.damaged(tile))
}

/// Returns the bytes of roads, which are in one of two kinds of section, and whether their
/// points are range-coded bits.
pub(crate) fn section_of_two(
    sections: &[StoredSection<'_>],
    kinds: TwoKinds,
) -> Result<Option<(Vec<u8>, bool)>> {
    match (section(sections, kinds.planes)?, section(sections, kinds.coded)?) {
        (Some(_), Some(_)) => Err(Damage::Invalid("two sections for the same objects")),
        (Some(planes), None) => Ok(Some((planes, false))),
        (None, coded) => Ok(coded.map(|coded| (coded, true))),
    }
}

/// Returns the section of one kind as it is stored; `None` if it is absent.
pub(crate) fn find<'a>(
    sections: &[StoredSection<'a>],
    kind: SectionKind,
) -> Option<StoredSection<'a>> {
    sections.iter().find(|section| section.kind == kind.number()).copied()
}

/// Returns the size of the section of one kind; 0 if it is absent.
pub(crate) fn size(sections: &[StoredSection<'_>], kind: SectionKind) -> SectionSize {
    let size = |section: StoredSection<'_>| SectionSize {
        raw: u64::from(section.raw_length),
        stored: section.stored_length as u64,
    };
    find(sections, kind).map(size).unwrap_or_default()
}

/// Returns the number of bytes of SV roads at the end of the payload; 0 if another section is the
/// last.
pub(crate) fn sv_tail_bytes(sections: &[StoredSection<'_>]) -> u64 {
    let last = sections.last().filter(|last| last.known_kind().is_some_and(SectionKind::is_sv));
    last.map_or(0, |last| last.stored_length as u64)
}

/// Checks sections of kinds that this version does not know, as far as possible.
pub(crate) fn check_unknown(sections: &[StoredSection<'_>]) -> Result<()> {
    let unknown = |section: &&StoredSection<'_>| section.known_kind().is_none();
    let intact = |section: &StoredSection<'_>| crc32fast::hash(section.bytes) == section.checksum;
    if sections.iter().filter(unknown).all(intact) { Ok(()) } else { Err(Damage::Checksum) }
}

/// Decompresses exactly one zstd frame, whose content must have exactly `length` bytes.
fn decompress(mut bytes: &[u8], length: usize) -> Result<Vec<u8>> {
    let failed = |error: &dyn std::fmt::Display| Damage::Decompress { reason: error.to_string() };
    let mut decoder = FrameDecoder::new();
    // A window never needs to be larger than the content; zstd's own smallest window is 1 KiB.
    decoder.set_max_window_size(length.max(1024) as u64);
    let mut out = vec![0; length];
    // `decode_all` is not used here: it accepts any number of frames, each of which may be empty.
    decoder.init(&mut bytes).map_err(|error| failed(&error))?;
    let mut written = 0;
    loop {
        decoder
            .decode_blocks(&mut bytes, BlockDecodingStrategy::UptoBytes(1 << 20))
            .map_err(|error| failed(&error))?;
        written += decoder.read(&mut out[written..]).map_err(|error| failed(&error))?;
        Damage::invalid_if(
            decoder.can_collect() > 0,
            "a section is longer than its table entry says",
        )?;
        if decoder.is_finished() {
            break;
        }
    }
    Damage::invalid_if(!bytes.is_empty(), "bytes after the compressed section")?;
    Damage::invalid_if(written != length, "a section is shorter than its table entry says")?;
    Ok(out)
}

/// The size of a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SectionSize {
    /// Bytes before compression.
    pub raw: u64,
    /// Bytes in the payload.
    pub stored: u64,
}

impl SectionSize {
    /// Returns this size, or `other` if this section is absent.
    pub(crate) fn or(self, other: Self) -> Self {
        if self.stored > 0 { self } else { other }
    }
}
