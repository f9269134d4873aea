//! For each short gate, the nodes on its left in the order in which a search for corners would
//! examine them.
//!
//! Most gates are a few cells long, and their corner is among the first nodes that see them under a
//! large angle. So these nodes are sorted once for each gate, and a search checks one after another
//! whether it has a vertex:
//!
//! ```text
//!      8 6 5 6 8        a gate a ► b and the order of the nodes on its left: equal numbers lie on one circle
//!      7 4 3 4 7        through a and b. The first node with a vertex is the corner, and another vertex with
//!      8 2 1 2 8        the same number ties with it
//!      · a ► b ·
//! ```

use std::sync::LazyLock;

use corniche_geom::TILE_NODES;

/// The largest difference of the columns, and of the rows, of a gate.
const LONGEST: i32 = 8;
/// The largest number of nodes of a list.
const NODES: usize = 128;
/// The largest distance of the nodes of a list from the gate's first end, in columns or rows.
pub(crate) const MARGIN: usize = 16;
/// The distance from a node to the node below it, in a grid whose rows have a margin between them.
pub(crate) const STRIDE: usize = TILE_NODES + MARGIN;

/// The number of different column differences, and of row differences.
const SIDE: usize = 2 * LONGEST as usize + 1;

static LISTS: LazyLock<NearCorners> = LazyLock::new(NearCorners::new);

/// The lists of all short gates.
#[derive(Debug)]
pub(crate) struct NearCorners {
    /// The start of the list of each gate, and the end of the last list.
    starts: Vec<u32>,
    nodes: Vec<NearNode>,
}

/// A node that may have the corner of a gate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NearNode(i16);

impl NearNode {
    /// The offset of the node from the gate's first end, in a grid with rows of [`STRIDE`].
    #[inline]
    pub(crate) fn offset(self) -> isize {
        isize::from(self.0 >> 1)
    }

    /// Whether the next node of the list sees the gate under the same angle.
    #[inline]
    pub(crate) fn ties_with_next(self) -> bool {
        self.0 & 1 == 1
    }
}

impl NearCorners {
    /// Returns the lists, which the first call computes.
    pub(crate) fn get() -> &'static Self {
        &LISTS
    }

    /// The nodes to the left of a gate that goes this many columns east and rows south, sorted by
    /// the angle under which they see the gate, the largest first; nodes with equal angles by row,
    /// then column. Every node that is not in the list sees the gate under a smaller angle than all
    /// nodes in it. Empty for a long gate.
    #[inline]
    pub(crate) fn near(&self, [columns, rows]: [i32; 2]) -> &[NearNode] {
        if columns.abs() > LONGEST || rows.abs() > LONGEST {
            return &[];
        }
        let gate = (rows + LONGEST) as usize * SIDE + (columns + LONGEST) as usize;
        &self.nodes[self.starts[gate] as usize..self.starts[gate + 1] as usize]
    }

    fn new() -> Self {
        let mut lists = Self { starts: vec![0], nodes: Vec::new() };
        for rows in -LONGEST..=LONGEST {
            for columns in -LONGEST..=LONGEST {
                lists.nodes.extend(list([columns, rows]));
                lists.starts.push(lists.nodes.len() as u32);
            }
        }
        lists
    }
}

/// A node near a gate: the cotangent under which it sees the gate, then its position.
#[derive(Debug, Clone, Copy)]
struct SeenNode {
    dot: i32,
    /// The cross product, which is above 0.
    cross: i32,
    row: i32,
    column: i32,
}

impl SeenNode {
    /// Whether it sees the gate under the same angle as another node.
    fn ties(&self, other: &Self) -> bool {
        self.dot * other.cross == other.dot * self.cross
    }
}

fn list([columns, rows]: [i32; 2]) -> impl Iterator<Item = NearNode> {
    let reach = MARGIN as i32;
    let mut seen: Vec<SeenNode> = (-reach..=reach)
        .flat_map(|row| (-reach..=reach).map(move |column| [column, row]))
        .filter_map(|[column, row]| {
            let cross = rows * column - columns * row;
            let dot = column * (column - columns) + row * (row - rows);
            (cross > 0).then_some(SeenNode { dot, cross, row, column })
        })
        .collect();
    let by_angle = |a: &SeenNode, b: &SeenNode| {
        (a.dot * b.cross).cmp(&(b.dot * a.cross)).then([a.row, a.column].cmp(&[b.row, b.column]))
    };
    if seen.len() > NODES {
        // Nodes outside the list may tie with the last one, so all nodes that tie with it are
        // omitted.
        let (before, &mut last, _) = seen.select_nth_unstable_by(NODES, by_angle);
        let kept = before.len();
        seen.truncate(kept);
        seen.retain(|node| !node.ties(&last));
    }
    seen.sort_unstable_by(by_angle);
    let ties: Vec<bool> = seen.windows(2).map(|pair| pair[0].ties(&pair[1])).collect();
    seen.into_iter().zip(ties.into_iter().chain([false])).map(|(node, ties)| {
        let offset = node.row * STRIDE as i32 + node.column;
        NearNode((offset * 2 + i32::from(ties)) as i16)
    })
}

#[cfg(test)]
#[path = "near_corners_tests.rs"]
mod tests;
