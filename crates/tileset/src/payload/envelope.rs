//! Header, section table and sections of a payload, without the contents of sections.

use std::io::Read;

use corniche_geom::TileId;
use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

use crate::limits::MAX_SECTION_BYTES;
use crate::payload::damage::{Damage, DecodeError};
use crate::payload::number_codes::Cursor;
use crate::payload::section_kind::{Kind, TwoKinds};

/// First bytes of every payload: "Corniche Tile".
pub(crate) const MAGIC: [u8; 4] = *b"CRNT";
/// Version of the payload's layout.
pub(crate) const VERSION: u16 = 1;
/// Stored bytes follow without compression.
pub(crate) const STORED: u8 = 0;
/// Stored bytes are one zstd frame.
pub(crate) const ZSTD: u8 = 1;

/// A section as it lies in the payload.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StoredSection<'a> {
    kind: u16,
    pub(crate) compression: u8,
    pub(crate) raw_length: u32,
    pub(crate) checksum: u32,
    /// How many bytes it has in a whole payload.
    stored_length: usize,
    /// The bytes themselves; none where the payload was read without its last section.
    pub(crate) bytes: &'a [u8],
}

impl StoredSection<'_> {
    /// Its kind, if this version knows it.
    pub(crate) fn known_kind(&self) -> Option<Kind> {
        Kind::ALL.iter().copied().find(|&kind| kind as u16 == self.kind)
    }

    /// Whether its bytes are there.
    fn is_read(&self) -> bool {
        self.bytes.len() == self.stored_length
    }
}

/// Takes a whole payload apart. Sections are not looked into yet; they lie end to end up to the payload's last byte, so
/// that each byte is covered by one checksum.
pub(crate) fn open(bytes: &[u8], id: TileId) -> Result<Vec<StoredSection<'_>>, Damage> {
    let sections = open_read(bytes, id)?;
    if sections.iter().all(StoredSection::is_read) { Ok(sections) } else { Err(Damage::TooShort) }
}

/// The same of a payload that may have been read without SV roads at its end.
pub(crate) fn open_read(bytes: &[u8], id: TileId) -> Result<Vec<StoredSection<'_>>, Damage> {
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
        if reserved != 0 {
            return Err(Damage::Invalid("a reserved byte of the section table is not 0"));
        }
        let section = StoredSection {
            kind,
            compression,
            raw_length: raw_length?,
            checksum: checksum?,
            stored_length,
            bytes: stored.unwrap_or_default(),
        };
        let is_last = sections.len() + 1 == usize::from(count);
        let may_be_missing = is_last && section.known_kind().is_some_and(Kind::is_sv);
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
        if from != end {
            return Err(Damage::Invalid("sections do not lie end to end"));
        }
        end = to;
    }
    if end != bytes.len() {
        return Err(Damage::Invalid("bytes after the last section"));
    }
    for (number, section) in sections.iter().enumerate() {
        if sections[..number].iter().any(|before| before.kind == section.kind) {
            return Err(Damage::Invalid("two sections of one kind"));
        }
    }
    // This check comes after the checksum, so its error means a payload in the wrong place, not a flipped bit.
    if (z, x, y) != (id.z(), id.x(), id.y()) {
        return Err(Damage::OtherTile { found: format!("{z}/{x}/{y}") });
    }
    Ok(sections)
}

/// The bytes of the section of one kind, decompressed and checked; `None` where it is absent.
pub(crate) fn section(
    sections: &[StoredSection<'_>],
    kind: Kind,
) -> Result<Option<Vec<u8>>, Damage> {
    let Some(section) = sections.iter().find(|section| section.kind == kind as u16) else {
        return Ok(None);
    };
    if !section.is_read() {
        return Err(Damage::TooShort);
    }
    let raw_length = section.raw_length as usize;
    if raw_length > MAX_SECTION_BYTES {
        return Err(Damage::TooLarge {
            what: "length of a section",
            length: raw_length as u64,
            limit: MAX_SECTION_BYTES as u64,
        });
    }
    if crc32fast::hash(section.bytes) != section.checksum {
        return Err(Damage::Checksum);
    }
    match section.compression {
        STORED if section.bytes.len() == raw_length => Ok(Some(section.bytes.to_vec())),
        STORED => Err(Damage::Invalid("the length of an uncompressed section")),
        // Writers compress where that makes a section smaller.
        ZSTD if section.bytes.len() < raw_length => decompress(section.bytes, raw_length).map(Some),
        ZSTD => Err(Damage::Invalid("the length of a compressed section")),
        _ => Err(Damage::Invalid("an unknown compression")),
    }
}

/// Reads something of the bytes of a payload by itself; damage is told with the tile and the part.
pub(crate) fn read_part<T>(
    bytes: &[u8],
    tile: TileId,
    part: &'static str,
    read: impl FnOnce(&[StoredSection<'_>]) -> Result<T, Damage>,
) -> Result<T, DecodeError> {
    let failed = |part| move |damage| DecodeError { tile, part, damage };
    let sections = open_read(bytes, tile).map_err(failed("header"))?;
    read(&sections).map_err(failed(part))
}

/// The same of roads or areas, and whether their points are range-coded bits: a section of one of two kinds.
pub(crate) fn section_of_two(
    sections: &[StoredSection<'_>],
    kinds: TwoKinds,
) -> Result<Option<(Vec<u8>, bool)>, Damage> {
    match (section(sections, kinds.planes)?, section(sections, kinds.coded)?) {
        (Some(_), Some(_)) => Err(Damage::Invalid("two sections for the same objects")),
        (Some(planes), None) => Ok(Some((planes, false))),
        (None, coded) => Ok(coded.map(|coded| (coded, true))),
    }
}

/// The section of one kind as it is stored; `None` where it is absent.
#[cfg(feature = "write")]
pub(crate) fn find<'a>(sections: &[StoredSection<'a>], kind: Kind) -> Option<StoredSection<'a>> {
    sections.iter().find(|section| section.kind == kind as u16).copied()
}

/// How large the section of one kind is; 0 where it is absent.
pub(crate) fn size(sections: &[StoredSection<'_>], kind: Kind) -> SectionSize {
    let of_kind = sections.iter().find(|section| section.kind == kind as u16);
    of_kind.map_or_else(SectionSize::default, |section| SectionSize {
        raw: u64::from(section.raw_length),
        stored: section.stored_length as u64,
    })
}

/// How many bytes SV roads take at the end of the payload; 0 where another section is the last.
pub(crate) fn sv_tail_bytes(sections: &[StoredSection<'_>]) -> u64 {
    let last = sections.last().filter(|last| last.known_kind().is_some_and(Kind::is_sv));
    last.map_or(0, |last| last.stored_length as u64)
}

/// Checks sections of kinds that this version does not know, as far as it can.
pub(crate) fn check_unknown(sections: &[StoredSection<'_>]) -> Result<(), Damage> {
    let unknown =
        |section: &&StoredSection<'_>| Kind::ALL.iter().all(|&kind| section.kind != kind as u16);
    let intact = |section: &StoredSection<'_>| crc32fast::hash(section.bytes) == section.checksum;
    if sections.iter().filter(unknown).all(intact) { Ok(()) } else { Err(Damage::Checksum) }
}

/// Decompresses one zstd frame, no more and no other, that must come to exactly `length` bytes.
fn decompress(mut bytes: &[u8], length: usize) -> Result<Vec<u8>, Damage> {
    let failed = |error: &dyn std::fmt::Display| Damage::Decompress { reason: error.to_string() };
    let mut decoder = FrameDecoder::new();
    // A window never needs to be larger than the content; zstd's own smallest window is 1 KiB.
    decoder.set_max_window_size(length.max(1024) as u64);
    let mut out = vec![0; length];
    // Not `decode_all`: it takes any number of frames, each of which may be empty.
    decoder.init(&mut bytes).map_err(|error| failed(&error))?;
    let mut written = 0;
    loop {
        decoder
            .decode_blocks(&mut bytes, BlockDecodingStrategy::UptoBytes(1 << 20))
            .map_err(|error| failed(&error))?;
        written += decoder.read(&mut out[written..]).map_err(|error| failed(&error))?;
        if decoder.can_collect() > 0 {
            return Err(Damage::Invalid("a section is longer than it says"));
        }
        if decoder.is_finished() {
            break;
        }
    }
    if !bytes.is_empty() {
        return Err(Damage::Invalid("bytes after the compressed section"));
    }
    if written != length {
        return Err(Damage::Invalid("a section is shorter than it says"));
    }
    Ok(out)
}

/// How large a section is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SectionSize {
    /// Bytes before compression.
    pub raw: u64,
    /// Bytes in the payload.
    pub stored: u64,
}

impl SectionSize {
    /// This, or `other` if this section is absent.
    pub(crate) fn or(self, other: Self) -> Self {
        if self.stored > 0 { self } else { other }
    }
}
