//! Errors of encoding and decoding a tile, and the kinds of damage that bytes can have.

use std::borrow::Cow;

use corniche_geom::TileId;

/// What is wrong with the bytes of a payload or section.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// The bytes end too early.
    #[error("the bytes end too early")]
    TooShort,
    /// The bytes do not begin as a payload does.
    #[error("the bytes are not a Corniche tile")]
    Magic,
    /// The payload has another version.
    #[error("payload version {found} is not supported; this program reads version {supported}")]
    Version {
        /// The version of the payload.
        found: u16,
        /// The version that this program reads.
        supported: u16,
    },
    /// The checksum does not match.
    #[error("the checksum does not match: the bytes are damaged")]
    Checksum,
    /// The payload belongs to another tile.
    #[error("the bytes belong to tile {found}")]
    OtherTile {
        /// The id of the tile in the payload, as `z/x/y`; it may be invalid.
        found: String,
    },
    /// A length is larger than readers accept.
    #[error("{what}: {length} is more than the limit of {limit}")]
    TooLarge {
        /// The value that is too large.
        what: &'static str,
        /// The length.
        length: u64,
        /// The limit.
        limit: u64,
    },
    /// Decoding takes more steps than a tile of this size may take; no writer creates a tile like
    /// this.
    #[error(
        "decoding takes more than the limit of {limit} steps; no writer creates a tile like this"
    )]
    TooMuchWork {
        /// The limit, in the steps of [`limits`](crate::limits).
        limit: u64,
    },
    /// Decompression failed.
    #[error("cannot decompress: {reason}")]
    Decompress {
        /// The error of the decompressor.
        reason: String,
    },
    /// A value is invalid: no writer writes it.
    #[error("invalid: {0}")]
    Invalid(&'static str),
    /// The triangles are not a TIN.
    #[error("not a TIN: {0}")]
    Tin(#[from] corniche_tin::TinError),
    /// The tile is beyond the finest level of the package.
    #[error("the package has no level {level}; its finest level is {finest}")]
    Level {
        /// The tile's level.
        level: u8,
        /// The package's finest level.
        finest: u8,
    },
}

/// Refuses what cannot be encoded, or was not encoded by a writer.
pub(crate) fn refuse_if(is_so: bool, what: &'static str) -> Result<(), &'static str> {
    if is_so { Err(what) } else { Ok(()) }
}

/// What decoders return.
pub(crate) type Result<T, E = Damage> = std::result::Result<T, E>;

impl Damage {
    /// Rejects invalid bytes.
    pub(crate) fn invalid_if(is_so: bool, what: &'static str) -> Result<()> {
        if is_so { Err(Self::Invalid(what)) } else { Ok(()) }
    }

    /// Rejects more than readers accept.
    pub(crate) fn limit(what: &'static str, length: u64, limit: usize) -> Result<()> {
        let limit = limit as u64;
        if length > limit { Err(Self::TooLarge { what, length, limit }) } else { Ok(()) }
    }

    /// Returns the error for damage in the header of a payload.
    pub(crate) fn in_header(self, tile: TileId) -> DecodeError {
        DecodeError { tile, part: "header".into(), damage: self }
    }
}

/// Why bytes could not be decoded into a tile.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("tile {tile}, {part}: {damage}; the package is damaged, download or build it again")]
pub struct DecodeError {
    /// The tile.
    pub tile: TileId,
    /// The part of the tile: "header", or the name of a section.
    pub part: Cow<'static, str>,
    /// The damage.
    pub damage: Damage,
}

/// Why a tile could not be encoded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EncodeError {
    /// The payload contains something that the encoding cannot represent.
    #[error("tile {tile}, {section}: cannot encode {what}")]
    Unencodable {
        /// The tile.
        tile: TileId,
        /// The section.
        section: Cow<'static, str>,
        /// The content that cannot be encoded.
        what: &'static str,
    },
    /// A section is larger than readers accept.
    #[error(
        "tile {tile}, {section}: {bytes} bytes are more than readers accept ({limit}); show fewer roads on this level or use a larger --max-error"
    )]
    TooLarge {
        /// The tile.
        tile: TileId,
        /// The section.
        section: Cow<'static, str>,
        /// The size of the section before compression.
        bytes: usize,
        /// The largest accepted size.
        limit: usize,
    },
    /// The compressor failed.
    #[error("tile {tile}, {section}: cannot compress: {reason}")]
    Compress {
        /// The tile.
        tile: TileId,
        /// The section.
        section: Cow<'static, str>,
        /// The error of the compressor.
        reason: String,
    },
}
