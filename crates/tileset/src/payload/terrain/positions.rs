//! Codes which nodes of the grid are vertices: one bit per node, in the context of the nodes before
//! it.

use corniche_geom::TILE_NODES;

use crate::payload::range_coder::{Bits, Model};

/// The number of columns before the first and after the last that contexts may read.
const MARGIN: usize = 8;
/// The number of rows above the current one that contexts read.
const ROWS: usize = 5;
const WIDTH: usize = TILE_NODES + 2 * MARGIN;

/// The classes of the number of vertices in a window, by the smallest number of each class.
const COUNT_STARTS: [u8; 13] = [1, 2, 3, 4, 5, 6, 7, 8, 10, 13, 17, 23, 31];
const COUNT_CLASSES: usize = 16;
const NEIGHBOURS: usize = 64;

/// Codes for each node, by row, then column, whether it is a vertex; returns the vertices' columns
/// and rows in this order.
///
/// `is_vertex` is called for each node in the same order; a reader's result is ignored.
///
/// ```text
///      · · · · · · · · · · ·       the window of the 5 rows above, 5 columns to each side, and 5 nodes to the west;
///      · · · · · · · · · · ·       the small window has 2 rows, 3 columns, 3 nodes
///      · · · · · · · · · · ·
///      · · · · · N · · · · ·       the six neighbours with bits of their own: the nearest two to the
///      · · · · N N N · · · ·       north and to the west, and the two beside the nearest in the north
///      · · · N N ?
/// ```
pub(crate) fn code_positions<B: Bits>(
    bits: &mut B,
    mut is_vertex: impl FnMut() -> bool,
) -> Vec<[u16; 2]> {
    let mut models = Models::new();
    let mut above = Above::new();
    let mut at = Vec::new();
    for row in 0..TILE_NODES {
        let row_border = usize::from(row == 0 || row == TILE_NODES - 1);
        let north = above.contexts();
        let here = above.begin_row();
        let mut west = 0_usize;
        for column in 0..TILE_NODES {
            let north = north.at(column);
            let border = row_border | usize::from(column == 0 || column == TILE_NODES - 1) << 1;
            let bit = bits.mixed(models.models_at(border, &north, west), u32::from(is_vertex()));
            // The following bits depend on a branch, not on the bit as a number: see the reader.
            west <<= 1;
            if bit == 1 {
                west |= 1;
                at.push([column as u16, row as u16]);
                here[column + MARGIN] = 1;
            }
        }
        above.end_row();
    }
    at
}

/// The models of nodes, by the class of border on which they are.
struct Models {
    by_neighbours: [[Model; NEIGHBOURS]; BORDERS],
    by_counts: [[[Model; COUNT_CLASSES]; COUNT_CLASSES]; BORDERS],
    /// The class of each number of vertices in a window.
    classes: [u8; 64],
}

/// The number of classes of borders: not in the first or last row or column; in such a row; in such
/// a column; in both.
const BORDERS: usize = 4;

/// The number of vertices among the last five nodes, which are the bits of the index.
const ONES: [u8; 32] = {
    let mut ones = [0; 32];
    let mut five = 1;
    while five < 32 {
        ones[five] = ones[five / 2] + five as u8 % 2;
        five += 1;
    }
    ones
};

impl Models {
    fn new() -> Self {
        let classes = std::array::from_fn(|count| {
            COUNT_STARTS.iter().take_while(|&&start| count >= usize::from(start)).count() as u8
        });
        Self {
            by_neighbours: [[Model::NEW; NEIGHBOURS]; BORDERS],
            by_counts: [[[Model::NEW; COUNT_CLASSES]; COUNT_CLASSES]; BORDERS],
            classes,
        }
    }

    /// The models of a node; `west` are the nodes to the west, as bits, the nearest in the lowest
    /// bit.
    #[inline]
    fn models_at(&mut self, border: usize, north: &North, west: usize) -> [&mut Model; 2] {
        let neighbours = usize::from(north.neighbours) | (west & 3) << 4;
        let [wide, near] = [north.wide + ONES[west & 31], north.near + ONES[west & 7]]
            .map(|count| usize::from(self.classes[usize::from(count) % 64]) % COUNT_CLASSES);
        [
            &mut self.by_neighbours[border % BORDERS][neighbours % NEIGHBOURS],
            &mut self.by_counts[border % BORDERS][wide][near],
        ]
    }
}

/// The contexts of a node from the rows above: four neighbours as bits, and the numbers of vertices
/// in both windows.
struct North {
    neighbours: u8,
    wide: u8,
    near: u8,
}

/// The contexts of each node of a row from the rows above, as three lists, so that they are
/// computed in vectors.
struct NorthOfRow {
    neighbours: [u8; TILE_NODES],
    wide: [u8; TILE_NODES],
    near: [u8; TILE_NODES],
}

impl NorthOfRow {
    #[inline]
    fn at(&self, column: usize) -> North {
        North {
            neighbours: self.neighbours[column],
            wide: self.wide[column],
            near: self.near[column],
        }
    }
}

/// The rows above the current one.
struct Above {
    /// The current row and the rows above it; each replaces the row that is [`KEPT`] above it.
    rows: [[u8; WIDTH]; KEPT],
    present: usize,
    /// The sums by column of the five rows above, and of the nearest two.
    sums: [u8; WIDTH],
    near_sums: [u8; WIDTH],
}

/// The number of rows that are kept.
const KEPT: usize = ROWS + 1;

impl Above {
    fn new() -> Self {
        Self { rows: [[0; WIDTH]; KEPT], present: 0, sums: [0; WIDTH], near_sums: [0; WIDTH] }
    }

    fn row(&self, above: usize) -> &[u8; WIDTH] {
        &self.rows[(self.present + KEPT - above) % KEPT]
    }

    /// Returns the contexts of each node of the current row from the rows above.
    fn contexts(&self) -> NorthOfRow {
        let (first, second) = (self.row(1), self.row(2));
        let (mut neighbours, mut wide, mut near) =
            ([0; TILE_NODES], [0; TILE_NODES], [0; TILE_NODES]);
        for (column, neighbours) in neighbours.iter_mut().enumerate() {
            let place = column + MARGIN;
            *neighbours =
                first[place] | first[place - 1] << 1 | first[place + 1] << 2 | second[place] << 3;
        }
        for from in MARGIN - 5..=MARGIN + 5 {
            for (sum, more) in wide.iter_mut().zip(&self.sums[from..from + TILE_NODES]) {
                *sum += more;
            }
        }
        for from in MARGIN - 3..=MARGIN + 3 {
            for (sum, more) in near.iter_mut().zip(&self.near_sums[from..from + TILE_NODES]) {
                *sum += more;
            }
        }
        NorthOfRow { neighbours, wide, near }
    }

    /// Begins a row without vertices.
    fn begin_row(&mut self) -> &mut [u8; WIDTH] {
        let row = &mut self.rows[self.present];
        row.fill(0);
        row
    }

    fn end_row(&mut self) {
        let (here, third, last) = (*self.row(0), *self.row(2), *self.row(ROWS));
        for (sum, (here, last)) in self.sums.iter_mut().zip(here.iter().zip(last)) {
            *sum = *sum + here - last;
        }
        for (sum, (here, third)) in self.near_sums.iter_mut().zip(here.iter().zip(third)) {
            *sum = *sum + here - third;
        }
        self.present = (self.present + 1) % KEPT;
    }
}
