//! The decoded photo of a tile and the border of texels around it.

use corniche_geom::TILE_CELLS;

/// The number of texels beyond a tile on each of its sides, which are the texels of its neighbours:
/// each of the texture's first four sizes (1, 1/2, 1/4, 1/8) then has at least one such texel, so
/// that it can be filtered up to its edge.
pub const PHOTO_BORDER: usize = 8;

/// The photo of a tile, decoded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Photo {
    /// A cell of the tile has 2^`levels` texels along each side.
    pub levels: u8,
    /// Red, green, blue and alpha (255, or 0 without a photo) of each texel of a square, row by row
    /// from the north. The square has [`Photo::side`] texels along each side. Texels without a
    /// photo may have any colour.
    pub rgba: Vec<u8>,
}

impl Photo {
    /// Number of texels along a side of the tile, without the border.
    #[must_use]
    pub fn tile_texels(&self) -> usize {
        tile_texels(self.levels)
    }

    /// Number of texels along a side, border included.
    #[must_use]
    pub fn side(&self) -> usize {
        side(self.levels)
    }
}

/// Number of texels along a side of a tile, without the border.
fn tile_texels(levels: u8) -> usize {
    (TILE_CELLS as usize) << levels
}

/// Number of texels along a side, border included.
pub(crate) fn side(levels: u8) -> usize {
    tile_texels(levels) + 2 * PHOTO_BORDER
}
