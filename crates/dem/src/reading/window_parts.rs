//! Rectangles of nodes within a window.

use corniche_geom::{NodeIndex, NodeWindow};

/// A rectangle of a window's nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WindowPart {
    pub(crate) column: usize,
    pub(crate) row: usize,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl WindowPart {
    pub(crate) fn nodes(self) -> impl Iterator<Item = (usize, usize)> {
        let columns = self.column..self.column + self.columns;
        (self.row..self.row + self.rows)
            .flat_map(move |row| columns.clone().map(move |column| (column, row)))
    }

    /// Splits the part across its longer side.
    pub(crate) fn halves(self) -> [Self; 2] {
        if self.columns >= self.rows {
            let west = self.columns / 2;
            [
                Self { columns: west, ..self },
                Self { column: self.column + west, columns: self.columns - west, ..self },
            ]
        } else {
            let north = self.rows / 2;
            [
                Self { rows: north, ..self },
                Self { row: self.row + north, rows: self.rows - north, ..self },
            ]
        }
    }
}

/// The position of a part within a window.
pub(crate) struct WindowTarget {
    /// The number of columns of the part.
    pub(crate) columns: usize,
    left: usize,
    top: usize,
    window_columns: usize,
}

impl WindowTarget {
    pub(crate) fn new(window: &NodeWindow, part: &NodeWindow) -> Self {
        Self {
            columns: part.columns,
            left: (part.corner.i - window.corner.i) as usize,
            top: (window.corner.j - part.corner.j) as usize,
            window_columns: window.columns,
        }
    }

    pub(crate) fn at(&self, column: usize, row: usize) -> usize {
        (self.top + row) * self.window_columns + self.left + column
    }
}

/// The part of a window between two nodes, both included.
pub(crate) fn intersection(
    window: &NodeWindow,
    [south_west, north_east]: [NodeIndex; 2],
) -> Option<NodeWindow> {
    let corner =
        NodeIndex { i: window.corner.i.max(south_west.i), j: window.corner.j.min(north_east.j) };
    let east = (window.corner.i + window.columns as i64 - 1).min(north_east.i);
    let south = (window.corner.j - window.rows as i64 + 1).max(south_west.j);
    (corner.i <= east && south <= corner.j).then(|| NodeWindow {
        corner,
        stride: 1,
        columns: (east - corner.i + 1) as usize,
        rows: (corner.j - south + 1) as usize,
    })
}
