//! Which nodes of the grid are vertices: one bit a node, in the context of the nodes before it.

use corniche_geom::TILE_NODES;

use crate::payload::range_coder::{Bits, Model};

/// Columns before the first and behind the last that contexts may look at.
const MARGIN: usize = 8;
/// Rows before the present one that contexts look at.
const ROWS: usize = 5;
const WIDTH: usize = TILE_NODES + 2 * MARGIN;

/// Classes of the number of vertices in a window, by their first number.
const COUNT_STARTS: [u8; 13] = [1, 2, 3, 4, 5, 6, 7, 8, 10, 13, 17, 23, 31];
const COUNT_CLASSES: usize = 16;
const NEIGHBOURS: usize = 64;

/// Codes for each node, by row, then column, whether it is a vertex; gives the vertices' columns and rows in this order.
///
/// `is_vertex` is asked for each node in the same order; a reader's answer does not matter.
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
            let bit = bits.mixed(models.of(border, &north, west), u32::from(is_vertex()));
            // What comes next follows from a branch, not from the bit as a number: see the reader.
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

/// What is known of nodes, by the class of border they lie on.
struct Models {
    by_neighbours: [[Model; NEIGHBOURS]; BORDERS],
    by_counts: [[[Model; COUNT_CLASSES]; COUNT_CLASSES]; BORDERS],
    /// The class of each number of vertices in a window.
    classes: [u8; 64],
}

/// In no first or last row or column; in such a row; in such a column; in both.
const BORDERS: usize = 4;

/// How many of the last five nodes, as bits, are vertices.
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

    /// The models of a node; `west` are the nodes to the west, as bits, the nearest in the lowest.
    #[inline]
    fn of(&mut self, border: usize, north: &North, west: usize) -> [&mut Model; 2] {
        let neighbours = usize::from(north.neighbours) | (west & 3) << 4;
        let [wide, near] = [north.wide + ONES[west & 31], north.near + ONES[west & 7]]
            .map(|count| usize::from(self.classes[usize::from(count) % 64]) % COUNT_CLASSES);
        [
            &mut self.by_neighbours[border % BORDERS][neighbours % NEIGHBOURS],
            &mut self.by_counts[border % BORDERS][wide][near],
        ]
    }
}

/// What the rows above say about a node: four neighbours as bits, and how many vertices both windows have.
struct North {
    neighbours: u8,
    wide: u8,
    near: u8,
}

/// What the rows above say about each node of a row. Three lists, which are made in vectors.
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

/// The rows above the present one.
struct Above {
    /// The present row and those above it, each in place of the one that lies [`KEPT`] above it.
    rows: [[u8; WIDTH]; KEPT],
    present: usize,
    /// The sums by column of the five rows above, and of the nearest two.
    sums: [u8; WIDTH],
    near_sums: [u8; WIDTH],
}

/// Rows that are kept.
const KEPT: usize = ROWS + 1;

impl Above {
    fn new() -> Self {
        Self { rows: [[0; WIDTH]; KEPT], present: 0, sums: [0; WIDTH], near_sums: [0; WIDTH] }
    }

    fn row(&self, above: usize) -> &[u8; WIDTH] {
        &self.rows[(self.present + KEPT - above) % KEPT]
    }

    /// What the rows above say about each node of the present one.
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

    /// The present row, with no vertex yet.
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
