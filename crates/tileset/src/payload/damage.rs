//! Errors of encoding and decoding a tile, and the kinds of damage that bytes can have.

use corniche_geom::TileId;

/// What is wrong with bytes that should be a payload or a section of one.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// The bytes end before what they announce.
    #[error("the bytes end too early")]
    TooShort,
    /// They do not begin as a payload does.
    #[error("the bytes are not a Corniche tile")]
    Magic,
    /// They were written by another version.
    #[error("payload version {found} is not supported; this program reads version {supported}")]
    Version {
        /// The version they say.
        found: u16,
        /// The version this program reads.
        supported: u16,
    },
    /// The checksum does not fit.
    #[error("the checksum does not fit: the bytes were damaged")]
    Checksum,
    /// The payload belongs to another tile.
    #[error("the bytes are those of tile {found}")]
    OtherTile {
        /// The tile they say, as `z/x/y`; may be one that cannot exist.
        found: String,
    },
    /// A length is beyond what a reader accepts.
    #[error("{what}: {length} is more than the limit of {limit}")]
    TooLarge {
        /// What is too large.
        what: &'static str,
        /// How large.
        length: u64,
        /// The limit.
        limit: u64,
    },
    /// Decoding takes more steps than are allowed for a tile of this size; no writer makes such a tile.
    #[error("it takes more than the limit of {limit} steps to decode: no writer makes such a tile")]
    TooMuchWork {
        /// The limit, in the steps of [`limits`](crate::limits).
        limit: u64,
    },
    /// Decompression failed.
    #[error("cannot decompress: {reason}")]
    Decompress {
        /// What the decompressor says.
        reason: String,
    },
    /// A value that no writer writes: what is not valid.
    #[error("not valid: {0}")]
    Invalid(&'static str),
    /// The triangles are not a TIN.
    #[error("not a TIN: {0}")]
    Tin(#[from] corniche_tin::TinError),
    /// The tile lies beyond the finest level of the package.
    #[error("the package has no level {level}; its finest is {finest}")]
    Level {
        /// The tile's level.
        level: u8,
        /// The finest level.
        finest: u8,
    },
}

/// Why bytes could not be decoded into a tile.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("tile {tile}, {part}: {damage}; the package is damaged, fetch or build it again")]
pub struct DecodeError {
    /// Which tile.
    pub tile: TileId,
    /// Which part of it: "header" or the name of a section.
    pub part: &'static str,
    /// What is wrong.
    pub damage: Damage,
}

/// Why a tile could not be encoded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EncodeError {
    /// The payload holds what the encoding cannot express.
    #[error("tile {tile}, {section}: cannot encode {what}")]
    Unencodable {
        /// Which tile.
        tile: TileId,
        /// Which section.
        section: &'static str,
        /// What cannot be encoded.
        what: &'static str,
    },
    /// A section is larger than readers accept.
    #[error(
        "tile {tile}, {section}: {bytes} bytes are more than readers accept ({limit}); show fewer roads on this level or use a larger --max-error"
    )]
    TooLarge {
        /// Which tile.
        tile: TileId,
        /// Which section.
        section: &'static str,
        /// Its size before compression.
        bytes: usize,
        /// The largest size.
        limit: usize,
    },
    /// The compressor failed.
    #[error("tile {tile}, {section}: cannot compress: {reason}")]
    Compress {
        /// Which tile.
        tile: TileId,
        /// Which section.
        section: &'static str,
        /// What the compressor says.
        reason: String,
    },
}
