//! The photo of a tile: a picture of the ground from above, read and written apart from the rest of the payload. Most readers do not
//! want it, and it can be copied from one payload to another as it is.

mod coverage;
mod decode;
#[cfg(feature = "write")]
mod encode;

use corniche_geom::{TILE_CELLS, TileId};

use crate::payload::damage::DecodeError;
use crate::payload::envelope;
use crate::payload::section_kind::Kind;

#[cfg(feature = "write")]
pub use encode::{PhotoSection, encode_photo, photo_section, with_photo};

/// Texels beyond a tile on each of its sides, which are those of its neighbours: each of the texture's first four sizes (1, 1/2, 1/4,
/// 1/8) then has at least one, so that it can be filtered to its very edge.
pub const PHOTO_BORDER: usize = 8;
/// The most levels of texels finer than the tile's cell.
pub const MAX_PHOTO_LEVELS: u8 = 4;

/// The photo of a tile, decoded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Photo {
    /// A cell of the tile has 2^levels texels along each side.
    pub levels: u8,
    /// Red, green, blue and alpha (255, or 0 where there is no photo) of each texel, row by row from the north, of a square of
    /// [`Photo::side`] texels a side. Texels without photo have any colour.
    pub rgba: Vec<u8>,
}

impl Photo {
    /// Texels along a side of the tile, without border.
    #[must_use]
    pub fn tile_texels(&self) -> usize {
        tile_texels(self.levels)
    }

    /// Texels along a side, border included.
    #[must_use]
    pub fn side(&self) -> usize {
        side(self.levels)
    }
}

/// Texels along a side of a tile, without border.
fn tile_texels(levels: u8) -> usize {
    (TILE_CELLS as usize) << levels
}

/// Texels along a side, border included.
fn side(levels: u8) -> usize {
    tile_texels(levels) + 2 * PHOTO_BORDER
}

/// Reads the photo of a tile from the bytes of its payload; `None` if it has none. Memory and work are bounded by
/// [`MAX_PHOTO_LEVELS`], whatever the bytes say.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or the photo is damaged.
pub fn decode_photo(bytes: &[u8], id: TileId) -> Result<Option<Photo>, DecodeError> {
    let failed = |part| move |damage| DecodeError { tile: id, part, damage };
    let sections = envelope::open(bytes, id).map_err(failed("header"))?;
    let inside = failed(Kind::Photo.name());
    let section = envelope::section(&sections, Kind::Photo).map_err(inside)?;
    section.map(|section| decode::decode(&section)).transpose().map_err(inside)
}

#[cfg(test)]
#[path = "photo_tests.rs"]
mod tests;
