//! The cells with ground along the borders of a tile, derived from its TIN.

use corniche_drape::{Neighbours, OwnedBorders};
use corniche_geom::TILE_CELLS;
use corniche_tin::Tin;

/// One bit for each of a border's 256 cells, from the west or from the north; bit k of word 0 is
/// cell k.
type Cells = [u64; TILE_CELLS as usize / 64];

/// Whether the cells along the borders of a tile have ground.
///
/// A TIN covers exactly the cells with ground, and does not extend beyond the tile. So a cell along
/// a border has ground where the border is part of the TIN's boundary. There the boundary is a row
/// of edges with both ends on the border.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct BorderCells {
    north: Cells,
    east: Cells,
    south: Cells,
    west: Cells,
}

impl BorderCells {
    /// Derives the cells along the borders of a tile from its TIN.
    #[must_use]
    pub fn from_tin(tin: &Tin) -> Self {
        let mut cells = Self::default();
        let last = TILE_CELLS as u16;
        for corners in tin.triangles() {
            let corners = corners.map(|vertex| tin.vertices()[vertex as usize]);
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                let (a, b) = (corners[a], corners[b]);
                let (columns, rows) = ([a.column, b.column], [a.row, b.row]);
                for (border, is_along, ends) in [
                    (&mut cells.north, rows == [0, 0], columns),
                    (&mut cells.south, rows == [last, last], columns),
                    (&mut cells.west, columns == [0, 0], rows),
                    (&mut cells.east, columns == [last, last], rows),
                ] {
                    if is_along {
                        set(border, ends);
                    }
                }
            }
        }
        cells
    }
}

/// Sets the bits of the cells between two nodes of a border.
fn set(border: &mut Cells, [a, b]: [u16; 2]) {
    for cell in a.min(b)..a.max(b).min(TILE_CELLS as u16) {
        border[usize::from(cell) / 64] |= 1 << (cell % 64);
    }
}

fn has(border: &Cells, cell: i64) -> bool {
    let word = usize::try_from(cell / 64).ok().and_then(|word| border.get(word));
    word.is_some_and(|word| word >> (cell % 64) & 1 == 1)
}

/// The border cells of a tile and of its four neighbours; empty for a tile without ground.
#[derive(Debug, Clone, Copy, Default)]
pub struct CellsAround {
    /// Border cells of the tile itself.
    pub own: BorderCells,
    /// Border cells of its northern neighbour.
    pub north: BorderCells,
    /// Border cells of its eastern neighbour.
    pub east: BorderCells,
    /// Border cells of its southern neighbour.
    pub south: BorderCells,
    /// Border cells of its western neighbour.
    pub west: BorderCells,
}

impl CellsAround {
    /// Returns the borders that the tile owns among these neighbours.
    #[must_use]
    pub fn owned(&self, neighbours: Neighbours) -> OwnedBorders {
        let last = TILE_CELLS - 1;
        OwnedBorders::among(neighbours).where_ground(|column, row| match (column, row) {
            (column, -1) => has(&self.north.south, column),
            (column, TILE_CELLS) => has(&self.south.north, column),
            (-1, row) => has(&self.west.east, row),
            (TILE_CELLS, row) => has(&self.east.west, row),
            (column, 0) => has(&self.own.north, column),
            (0, row) => has(&self.own.west, row),
            (column, row) if row == last => has(&self.own.south, column),
            (_, row) => has(&self.own.east, row),
        })
    }
}

#[cfg(test)]
#[path = "border_cells_tests.rs"]
mod tests;
