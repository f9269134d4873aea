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
    let classes: [u8; 64] = std::array::from_fn(|count| {
        COUNT_STARTS.iter().take_while(|&&start| count >= usize::from(start)).count() as u8
    });
    let mut by_neighbours = [[Model::NEW; NEIGHBOURS]; 4];
    let mut by_counts = [[[Model::NEW; COUNT_CLASSES]; COUNT_CLASSES]; 4];
    // The rows above, the nearest first, and their sums by column.
    let mut above = [[0_u8; WIDTH]; ROWS];
    let (mut sums, mut near_sums) = ([0_u8; WIDTH], [0_u8; WIDTH]);
    let mut at = Vec::new();
    for row in 0..TILE_NODES {
        let mut here = [0_u8; WIDTH];
        let mut west = 0_usize;
        let mut sum: u8 = sums[MARGIN - 5..MARGIN + 5].iter().sum();
        let mut near_sum: u8 = near_sums[MARGIN - 3..MARGIN + 3].iter().sum();
        let row_border = usize::from(row == 0 || row == TILE_NODES - 1);
        for column in 0..TILE_NODES {
            let place = column + MARGIN;
            sum += sums[place + 5];
            near_sum += near_sums[place + 3];
            let neighbours = usize::from(above[0][place])
                | usize::from(above[0][place - 1]) << 1
                | usize::from(above[0][place + 1]) << 2
                | usize::from(above[1][place]) << 3
                | (west & 3) << 4;
            let wide = sum + (west & 31).count_ones() as u8;
            let near = near_sum + (west & 7).count_ones() as u8;
            let border = row_border | usize::from(column == 0 || column == TILE_NODES - 1) << 1;
            let models = [
                &mut by_neighbours[border][neighbours],
                &mut by_counts[border][usize::from(classes[usize::from(wide)])]
                    [usize::from(classes[usize::from(near)])],
            ];
            let bit = bits.mixed(models, u32::from(is_vertex()));
            if bit == 1 {
                at.push([column as u16, row as u16]);
                here[place] = 1;
            }
            west = west << 1 | bit as usize;
            sum -= sums[place - 5];
            near_sum -= near_sums[place - 3];
        }
        for place in MARGIN..WIDTH - MARGIN {
            sums[place] = sums[place] + here[place] - above[ROWS - 1][place];
            near_sums[place] = near_sums[place] + here[place] - above[1][place];
        }
        above.rotate_right(1);
        above[0] = here;
    }
    at
}
