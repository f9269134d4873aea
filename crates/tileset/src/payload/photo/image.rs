//! The decoded photo of a tile and the border of texels around it.

use corniche_geom::TILE_CELLS;

/// Texels beyond a tile on each of its sides, which are those of its neighbours: each of the texture's first four sizes (1, 1/2, 1/4,
/// 1/8) then has at least one, so that it can be filtered to its very edge.
pub const PHOTO_BORDER: usize = 8;

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
pub(crate) fn side(levels: u8) -> usize {
    tile_texels(levels) + 2 * PHOTO_BORDER
}
