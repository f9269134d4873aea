//! The stretches of borders that a tile owns, so that a line along a border is kept exactly once.

use corniche_geom::{TILE_CELLS, TileId};

/// The stretches of its four borders that a tile owns: a line exactly along the border of two tiles
/// must be kept by one of them, and only one, so that nothing is drawn twice and lengths add up.
///
/// The boundary of the ground belongs to the ground. So a stretch of border belongs to the tile
/// that has ground next to it, and if that does not decide, to the tile in the east or south, as in
/// `GridFrame::tile_column_row`. Both tiles know the cells on both sides (those of the neighbour
/// through their halo) and make the same decision, cell by cell:
///
/// ```text
///       west tile │ east tile        the stretch belongs to
///          void   │  ground     ►    the eastern
///        ground   │  ground     ►    the eastern
///        ground   │   void      ◄    the western: the eastern has nothing to lay a line on
///          void   │   void      ►    the eastern, which counts it as over no ground
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OwnedBorders {
    north: Cells,
    east: Cells,
    south: Cells,
    west: Cells,
}

/// Which neighbours exist: they keep lines along the border that they share with the tile, or at
/// least count them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Neighbours {
    /// Whether there is a neighbour in the east.
    pub east: bool,
    /// Whether there is a neighbour in the south.
    pub south: bool,
}

/// A border of a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TileBorder {
    North,
    East,
    South,
    West,
}

/// A bit for each of a border's 256 cells, from the west or from the north; bit k of word 0 is cell
/// k.
type Cells = [u64; 4];

const NONE: Cells = [0; 4];
const EVERY: Cells = [u64::MAX; 4];

impl OwnedBorders {
    /// All four borders, as a whole.
    pub const ALL: Self = Self { north: EVERY, east: EVERY, south: EVERY, west: EVERY };

    /// The borders that a tile of a level owns if there is ground everywhere: its west and north
    /// border, and its east or south border at the edge of the root.
    #[must_use]
    pub fn of_tile(id: TileId) -> Self {
        let there = |east, south| id.neighbour(east, south).is_some();
        Self::among(Neighbours { east: there(1, 0), south: there(0, 1) })
    }

    /// The borders that a tile with these neighbours owns if there is ground everywhere.
    #[must_use]
    pub fn among(neighbours: Neighbours) -> Self {
        let unless = |neighbour: bool| if neighbour { NONE } else { EVERY };
        let (east, south) = (unless(neighbours.east), unless(neighbours.south));
        Self { north: EVERY, east, south, west: EVERY }
    }

    /// Restricts the borders to cells with ground, according to `ground(column, row)`: columns and
    /// rows of the tile's own cells are 0 to 255, counted from the north-west; −1 and 256 are the
    /// neighbours' adjacent cells.
    #[must_use]
    pub fn where_ground(mut self, ground: impl Fn(i64, i64) -> bool) -> Self {
        let last = TILE_CELLS - 1;
        let settle =
            |cells: &mut Cells, own: &dyn Fn(i64) -> bool, beyond: &dyn Fn(i64) -> bool| {
                for cell in 0..TILE_CELLS {
                    let (word, bit) = (cell as usize / 64, 1 << (cell % 64));
                    match (own(cell), beyond(cell)) {
                        (true, false) => cells[word] |= bit,
                        (false, true) => cells[word] &= !bit,
                        (true, true) | (false, false) => {}
                    }
                }
            };
        settle(&mut self.north, &|column| ground(column, 0), &|column| ground(column, -1));
        settle(&mut self.south, &|column| ground(column, last), &|column| ground(column, last + 1));
        settle(&mut self.west, &|row| ground(0, row), &|row| ground(-1, row));
        settle(&mut self.east, &|row| ground(last, row), &|row| ground(last + 1, row));
        self
    }

    /// The next run of owned cells of a border from cell `from` on: the first, and one past the
    /// last.
    pub(crate) fn next_run(&self, border: TileBorder, from: i64) -> Option<[i64; 2]> {
        let cells = match border {
            TileBorder::North => &self.north,
            TileBorder::East => &self.east,
            TileBorder::South => &self.south,
            TileBorder::West => &self.west,
        };
        let owns = |cell: &i64| cells[*cell as usize / 64] >> (cell % 64) & 1 == 1;
        let first = (from..TILE_CELLS).find(owns)?;
        let end = (first..TILE_CELLS).find(|cell| !owns(cell)).unwrap_or(TILE_CELLS);
        Some([first, end])
    }
}

#[cfg(test)]
#[path = "owned_borders_tests.rs"]
mod tests;
