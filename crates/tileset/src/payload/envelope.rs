//! Header, section table and sections of a payload, without the contents of sections.

#[cfg(feature = "write")]
use std::borrow::Cow;
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
/// Bytes before the section table.
#[cfg(feature = "write")]
const HEADER_BYTES: usize = 16;
/// Bytes of one entry of the section table.
#[cfg(feature = "write")]
const ENTRY_BYTES: usize = 20;
/// Stored bytes follow without compression.
pub(crate) const STORED: u8 = 0;
/// Stored bytes are one zstd frame.
pub(crate) const ZSTD: u8 = 1;

/// A section as it lies in the payload.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StoredSection<'a> {
    kind: u16,
    compression: u8,
    raw_length: u32,
    checksum: u32,
    /// How many bytes it has in a whole payload.
    stored_length: usize,
    /// The bytes themselves; none where the payload was read without its last section.
    bytes: &'a [u8],
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

/// zstd's level: from 16 on it splits blocks where the statistics change, which suits streams laid end to end; 19
/// saves less than 1 % more at twice the time.
#[cfg(feature = "write")]
const COMPRESSION_LEVEL: i32 = 16;

/// What a section is made of.
#[cfg(feature = "write")]
pub(crate) enum Content<'a> {
    /// Bytes before compression.
    Raw(Vec<u8>),
    /// Bytes that do not become smaller by compression.
    Packed(Cow<'a, [u8]>),
    /// Bytes as another payload of the tile has them.
    Stored(StoredSection<'a>),
}

/// The payload of a tile with one more section, and the sizes of all; `already` says in an error that it has one of this kind.
#[cfg(feature = "write")]
pub(crate) fn with_section(
    payload: &[u8],
    tile: TileId,
    (kind, content): (Kind, Content<'_>),
    already: &'static str,
) -> Result<(Vec<u8>, Vec<SectionSize>), crate::payload::damage::EncodeError> {
    use crate::payload::damage::EncodeError;

    let refused = |what| EncodeError::Unencodable { tile, section: kind.name(), what };
    let sections = open(payload, tile).map_err(|_| refused("beside a damaged payload"))?;
    let mut contents = Vec::with_capacity(sections.len() + 1);
    for stored in sections {
        let known =
            stored.known_kind().ok_or_else(|| refused("beside a section of unknown kind"))?;
        if known == kind {
            return Err(refused(already));
        }
        contents.push((known, Content::Stored(stored)));
    }
    contents.push((kind, content));
    seal(tile, &contents)
}

/// Puts header, table and sections together, SV roads last; compresses each section where that makes it smaller. The sizes are in the order of `sections`.
#[cfg(feature = "write")]
pub(crate) fn seal(
    id: TileId,
    sections: &[(Kind, Content<'_>)],
) -> Result<(Vec<u8>, Vec<SectionSize>), crate::payload::damage::EncodeError> {
    use crate::payload::damage::EncodeError;

    let mut table = Vec::with_capacity(HEADER_BYTES + sections.len() * ENTRY_BYTES + 4);
    table.extend(MAGIC);
    table.extend(VERSION.to_le_bytes());
    table.extend([sections.len() as u8, id.z()]);
    table.extend(id.x().to_le_bytes());
    table.extend(id.y().to_le_bytes());
    let mut body: Vec<u8> = Vec::new();
    let mut sizes = vec![SectionSize::default(); sections.len()];
    let (last, first): (Vec<_>, Vec<_>) =
        sections.iter().enumerate().partition(|(_, (kind, _))| kind.is_sv());
    let start = HEADER_BYTES + sections.len() * ENTRY_BYTES + 4;
    for (place, (kind, content)) in first.into_iter().chain(last) {
        let section = kind.name();
        let compressed;
        let (compression, stored, raw_length, checksum) = match content {
            Content::Stored(stored) => {
                (stored.compression, stored.bytes, stored.raw_length as usize, stored.checksum)
            }
            Content::Packed(raw) => {
                check_size(id, section, raw)?;
                (STORED, raw.as_ref(), raw.len(), crc32fast::hash(raw))
            }
            Content::Raw(raw) => {
                check_size(id, section, raw)?;
                compressed = zstd::bulk::compress(raw, COMPRESSION_LEVEL).map_err(|error| {
                    EncodeError::Compress { tile: id, section, reason: error.to_string() }
                })?;
                let (compression, stored) =
                    if compressed.len() < raw.len() { (ZSTD, &compressed) } else { (STORED, raw) };
                (compression, stored.as_slice(), raw.len(), crc32fast::hash(stored))
            }
        };
        table.extend((*kind as u16).to_le_bytes());
        table.extend([compression, 0]);
        for number in [start + body.len(), stored.len(), raw_length] {
            table.extend((number as u32).to_le_bytes());
        }
        table.extend(checksum.to_le_bytes());
        body.extend(stored);
        sizes[place] = SectionSize { raw: raw_length as u64, stored: stored.len() as u64 };
    }
    table.extend(crc32fast::hash(&table).to_le_bytes());
    table.extend(body);
    Ok((table, sizes))
}

/// Fails if readers would refuse a section for its size.
#[cfg(feature = "write")]
fn check_size(
    tile: TileId,
    section: &'static str,
    raw: &[u8],
) -> Result<(), crate::payload::damage::EncodeError> {
    if raw.len() > MAX_SECTION_BYTES {
        let (bytes, limit) = (raw.len(), MAX_SECTION_BYTES);
        return Err(crate::payload::damage::EncodeError::TooLarge { tile, section, bytes, limit });
    }
    Ok(())
}
