//! Nodes of the global grid, and windows of them on one level.

use serde::{Deserialize, Serialize};

/// A node of the package's global grid at the finest level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct NodeIndex {
    /// Number of nodes east of the frame's origin.
    pub i: i64,
    /// Number of nodes north of the frame's origin.
    pub j: i64,
}

/// A rectangle of nodes of one level: north-west node, spacing and count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NodeWindow {
    /// The north-west node.
    pub corner: NodeIndex,
    /// The spacing in finest cells: 1 at the finest level, 2 at the next coarser one.
    pub stride: i64,
    /// Number of nodes from west to east.
    pub columns: usize,
    /// Number of nodes from north to south.
    pub rows: usize,
}

impl NodeWindow {
    /// The node in `column` from the west and `row` from the north.
    #[must_use]
    pub fn node(&self, column: usize, row: usize) -> NodeIndex {
        NodeIndex {
            i: self.corner.i + column as i64 * self.stride,
            j: self.corner.j - row as i64 * self.stride,
        }
    }

    /// Returns the window with `halo` more nodes on every side.
    #[must_use]
    pub fn with_halo(&self, halo: usize) -> Self {
        let reach = halo as i64 * self.stride;
        Self {
            corner: NodeIndex { i: self.corner.i - reach, j: self.corner.j + reach },
            stride: self.stride,
            columns: self.columns + 2 * halo,
            rows: self.rows + 2 * halo,
        }
    }
}
