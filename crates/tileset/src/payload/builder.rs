//! The payload of a tile is put together: each layer gives its section, and all of them are sealed once.

use corniche_geom::TileId;
use corniche_roads::FunctionalRoadClass;

use crate::limits::MAX_SECTION_BYTES;
use crate::payload::damage::EncodeError;
use crate::payload::envelope::{self, MAGIC, STORED, SectionSize, StoredSection, VERSION, ZSTD};
use crate::payload::section_kind::Kind;
use crate::payload::sizes::PayloadSizes;

/// Bytes before the section table.
const HEADER_BYTES: usize = 16;
/// Bytes of one entry of the section table.
const ENTRY_BYTES: usize = 20;
/// zstd's level: from 16 on it splits blocks where the statistics change, which suits streams laid end to end; 19
/// saves less than 1 % more at twice the time.
const COMPRESSION_LEVEL: i32 = 16;

/// What a layer has in a tile, encoded as a section of its payload.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Section {
    pub(crate) kind: Kind,
    pub(crate) bytes: Vec<u8>,
}

impl Section {
    /// Its bytes before compression.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// What [`Section::of_areas`] and its like take: its bytes, and where a layer has two kinds of section, a first one that tells which it is.
    #[must_use]
    pub fn into_bytes(self) -> Vec<u8> {
        match self.kind {
            Kind::Areas => [&[0], &self.bytes[..]].concat(),
            Kind::CodedAreas => [&[1], &self.bytes[..]].concat(),
            _ => self.bytes,
        }
    }

    /// How large it is in the payload of a tile.
    ///
    /// # Errors
    /// When it is larger than readers accept.
    pub fn size(&self, tile: TileId) -> Result<SectionSize, EncodeError> {
        let stored = compressed(tile, self)?;
        let stored = stored.as_ref().unwrap_or(&self.bytes).len() as u64;
        Ok(SectionSize { raw: self.bytes.len() as u64, stored })
    }
}

/// A payload as bytes, and the sizes of its parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EncodedTile {
    /// The payload.
    pub bytes: Vec<u8>,
    /// The sizes of its parts.
    pub sizes: PayloadSizes,
}

/// The payload of a tile while it is put together.
#[derive(Debug)]
pub struct PayloadBuilder<'a> {
    tile: TileId,
    sections: Vec<Content<'a>>,
    /// Bytes of each class in the sections of roads, GEO and SV, before compression; 0 where these were stored before.
    pub(crate) class_bytes: [[u64; FunctionalRoadClass::COUNT]; 2],
}

/// What a section is made of.
#[derive(Debug)]
enum Content<'a> {
    New(Section),
    /// Bytes as another payload of the tile has them.
    Stored(Kind, StoredSection<'a>),
}

impl Content<'_> {
    fn kind(&self) -> Kind {
        match self {
            Self::New(section) => section.kind,
            Self::Stored(kind, _) => *kind,
        }
    }
}

impl<'a> PayloadBuilder<'a> {
    /// A payload without any section.
    #[must_use]
    pub fn new(tile: TileId) -> Self {
        Self { tile, sections: Vec::new(), class_bytes: Default::default() }
    }

    /// A payload with all sections of another one of the tile, which stay as they are stored there. What the classes of its roads take is not looked at.
    ///
    /// # Errors
    /// When the bytes are no payload of the tile, or have a section of unknown kind.
    pub fn with_all_of(payload: &'a [u8], tile: TileId) -> Result<Self, EncodeError> {
        let refused = |what| EncodeError::Unencodable { tile, section: "other sections", what };
        let sections = envelope::open(payload, tile).map_err(|_| refused("a damaged payload"))?;
        let mut builder = Self::new(tile);
        for stored in sections {
            let kind = stored.known_kind();
            let kind = kind.ok_or_else(|| refused("a section of unknown kind"))?;
            builder.sections.push(Content::Stored(kind, stored));
        }
        Ok(builder)
    }

    /// Takes the section of a kind as it is stored in another payload of the tile.
    pub(crate) fn add_stored(&mut self, kind: Kind, stored: StoredSection<'a>) {
        self.sections.push(Content::Stored(kind, stored));
    }

    /// Adds a section.
    ///
    /// # Errors
    /// When the payload has one for the same objects already, or bridges and tunnels come before the ground.
    pub fn add(&mut self, section: Section) -> Result<(), EncodeError> {
        let mut kinds = self.sections.iter().map(Content::kind);
        let name = section.kind.name();
        let refused = |what| EncodeError::Unencodable { tile: self.tile, section: name, what };
        // Both kinds of a layer that can be in one of two have one name.
        if kinds.clone().any(|other| other.name() == name) {
            return Err(refused("beside others"));
        }
        if section.kind == Kind::Spans && !kinds.any(|other| other == Kind::Terrain) {
            return Err(refused("without ground"));
        }
        self.sections.push(Content::New(section));
        Ok(())
    }

    /// Puts header, table and sections together, SV roads last; compresses each new section where that makes it smaller.
    ///
    /// # Errors
    /// When a section is larger than readers accept.
    pub fn seal(mut self) -> Result<EncodedTile, EncodeError> {
        self.sections.sort_by_key(|content| content.kind().is_sv());
        let Self { tile, sections, class_bytes } = self;
        let start = HEADER_BYTES + sections.len() * ENTRY_BYTES + 4;
        let mut table = Vec::with_capacity(start);
        table.extend(MAGIC);
        table.extend(VERSION.to_le_bytes());
        table.extend([sections.len() as u8, tile.z()]);
        table.extend(tile.x().to_le_bytes());
        table.extend(tile.y().to_le_bytes());
        let mut body: Vec<u8> = Vec::new();
        let mut sizes = Vec::with_capacity(sections.len());
        for content in &sections {
            let smaller;
            let (compression, stored, raw_length, checksum) = match content {
                Content::Stored(_, stored) => {
                    (stored.compression, stored.bytes, stored.raw_length as usize, stored.checksum)
                }
                Content::New(section) => {
                    let raw = &section.bytes;
                    smaller = compressed(tile, section)?;
                    let (compression, stored) =
                        smaller.as_ref().map_or((STORED, raw), |smaller| (ZSTD, smaller));
                    (compression, stored.as_slice(), raw.len(), crc32fast::hash(stored))
                }
            };
            table.extend((content.kind() as u16).to_le_bytes());
            table.extend([compression, 0]);
            for number in [start + body.len(), stored.len(), raw_length] {
                table.extend((number as u32).to_le_bytes());
            }
            table.extend(checksum.to_le_bytes());
            body.extend(stored);
            let size = SectionSize { raw: raw_length as u64, stored: stored.len() as u64 };
            sizes.push((content.kind(), size));
        }
        table.extend(crc32fast::hash(&table).to_le_bytes());
        table.extend(body);
        let size = |kind| {
            let of_kind = sizes.iter().find(|(of, _)| *of == kind);
            of_kind.map_or_else(SectionSize::default, |(_, size)| *size)
        };
        let sv_tail = sizes.last().filter(|(kind, _)| kind.is_sv());
        let sv_tail = sv_tail.map_or(0, |(_, size)| size.stored);
        Ok(EncodedTile { bytes: table, sizes: PayloadSizes::of(size, sv_tail, class_bytes) })
    }
}

/// A section compressed; `None` where that does not make it smaller.
fn compressed(tile: TileId, section: &Section) -> Result<Option<Vec<u8>>, EncodeError> {
    let Section { kind, bytes } = section;
    let section = kind.name();
    if bytes.len() > MAX_SECTION_BYTES {
        let (bytes, limit) = (bytes.len(), MAX_SECTION_BYTES);
        return Err(EncodeError::TooLarge { tile, section, bytes, limit });
    }
    if kind.is_dense() {
        return Ok(None);
    }
    smaller(bytes).map_err(|error| EncodeError::Compress {
        tile,
        section,
        reason: error.to_string(),
    })
}

fn smaller(raw: &[u8]) -> std::io::Result<Option<Vec<u8>>> {
    let compressed = zstd::bulk::compress(raw, COMPRESSION_LEVEL)?;
    Ok(Some(compressed).filter(|compressed| compressed.len() < raw.len()))
}

/// A payload of any sections, also of some that no writer puts beside each other.
#[cfg(test)]
pub(crate) fn payload_of<const N: usize>(tile: TileId, sections: [(Kind, Vec<u8>); N]) -> Vec<u8> {
    let mut builder = PayloadBuilder::new(tile);
    let section = |(kind, bytes)| Content::New(Section { kind, bytes });
    builder.sections.extend(sections.map(section));
    builder.seal().expect("sections are small").bytes
}
