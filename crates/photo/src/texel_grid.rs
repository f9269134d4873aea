//! The grid of texels over the finest tiles, and windows of it.

use corniche_geom::{GridFrame, TILE_CELLS, TileId};

use crate::PhotoError;

/// The most levels of texels finer than the finest cell.
pub const MAX_LEVELS: u8 = 4;

/// Texels over the finest tiles of a package: a cell has 2^levels along each side.
///
/// Texel (u, v) is between nodes: u counts eastwards and v southwards from node (0, 0), in texels.
/// Texels are therefore the same for every tile that contains them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TexelGrid {
    frame: GridFrame,
    levels: u8,
}

/// A rectangle of texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TexelWindow {
    /// Column of the first texel.
    pub u: i64,
    /// Row of the first texel.
    pub v: i64,
    /// Texels along a row.
    pub columns: usize,
    /// Rows.
    pub rows: usize,
}

impl TexelGrid {
    /// The texels over a package's grid.
    ///
    /// # Errors
    /// When there are more than [`MAX_LEVELS`].
    pub fn new(frame: GridFrame, levels: u8) -> Result<Self, PhotoError> {
        if levels > MAX_LEVELS {
            return Err(PhotoError::Levels { levels, most: MAX_LEVELS });
        }
        Ok(Self { frame, levels })
    }

    /// Returns the texels of any number of levels, for reading by windows.
    pub(crate) fn of_any(frame: GridFrame, levels: u8) -> Self {
        Self { frame, levels }
    }

    /// The number of levels of texels finer than the finest cell.
    #[must_use]
    pub fn levels(&self) -> u8 {
        self.levels
    }

    /// Texels along a side of a finest tile.
    #[must_use]
    pub fn tile_texels(&self) -> usize {
        (TILE_CELLS as usize) << self.levels
    }

    /// Returns the texels of a tile of the finest level, with `border` more on every side.
    ///
    /// # Panics
    /// When the tile's level is beyond the finest one.
    #[must_use]
    pub fn tile(&self, id: TileId, border: usize) -> TexelWindow {
        let corner = self.frame.tile_corner(id);
        let side = self.tile_texels() + 2 * border;
        let first = |node: i64| (node << self.levels) - border as i64;
        TexelWindow { u: first(corner.i), v: first(-corner.j), columns: side, rows: side }
    }

    /// Returns the position in working metres of a point, given in texels from node (0, 0)
    /// eastwards and southwards.
    pub(crate) fn position_m(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [x0, y0] = self.frame.origin_m();
        let cell = self.frame.cell();
        // A power of two, so it is exact.
        let per_cell = f64::from(1_u32 << self.levels);
        [x0 + cell.east_m * (u / per_cell), y0 - cell.north_m * (v / per_cell)]
    }
}
