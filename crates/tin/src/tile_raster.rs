//! The heights of one tile with a border of one node around it.

use corniche_geom::HeightGrid;

use crate::TinVertex;

/// The nodes of one tile, read from a grid that has one more node on each side.
///
/// ```text
///   grid column   0   1   2        columns + 1
///                 h   h   h   …   h   h          h: halo
///                 h   n───n   …   n   h          n: node of the tile
///                     │ g │                      g: cell (0, 0)
///   node column       0   1
/// ```
pub(crate) struct TileRaster<'a> {
    heights: &'a HeightGrid,
    quantum_m: f64,
    /// Whether a cell has ground, halo cells included: (`columns` + 1) × (`rows` + 1), row by row.
    ground: Vec<bool>,
}

impl<'a> TileRaster<'a> {
    pub(crate) fn new(heights: &'a HeightGrid, quantum_m: f64) -> Self {
        let (columns, rows) = (heights.columns() - 1, heights.rows() - 1);
        let raw = heights.raw();
        let width = heights.columns();
        let mut ground = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            let north = &raw[row * width..(row + 1) * width];
            let south = &raw[(row + 1) * width..(row + 2) * width];
            ground.extend(north.windows(2).zip(south.windows(2)).map(|(n, s)| {
                // A sum is NaN exactly if one of its terms is NaN: other heights are finite, and
                // their sum is within the range of f64.
                !(f64::from(n[0]) + f64::from(n[1]) + f64::from(s[0]) + f64::from(s[1])).is_nan()
            }));
        }
        Self { heights, quantum_m, ground }
    }

    /// Number of nodes of the tile from west to east.
    pub(crate) fn columns(&self) -> usize {
        self.heights.columns() - 2
    }

    /// Number of nodes of the tile from north to south.
    pub(crate) fn rows(&self) -> usize {
        self.heights.rows() - 2
    }

    /// The heights of one row of the tile's nodes, NaN in gaps.
    pub(crate) fn row_m(&self, row: usize) -> &[f32] {
        let start = (row + 1) * self.heights.columns() + 1;
        &self.heights.raw()[start..start + self.columns()]
    }

    /// The height of a node in metres; NaN in a gap.
    pub(crate) fn height_m(&self, [column, row]: [usize; 2]) -> f64 {
        f64::from(self.row_m(row)[column])
    }

    /// The height of a node in whole steps of the quantum. The caller has checked that heights fit.
    pub(crate) fn height_q(&self, node: [usize; 2]) -> i32 {
        let steps = self.height_m(node) / self.quantum_m;
        // Rounds like `f64::round`, halves away from zero, but without a function call: the cast is
        // exact.
        let whole = steps as i32;
        let rest = steps - f64::from(whole);
        whole + i32::from(rest >= 0.5) - i32::from(rest <= -0.5)
    }

    /// Returns a node as a vertex.
    pub(crate) fn vertex(&self, [column, row]: [u16; 2]) -> TinVertex {
        TinVertex { row, column, height_q: self.height_q([usize::from(column), usize::from(row)]) }
    }

    /// Whether the cell south-east of node (`column` − 1, `row` − 1) has ground: `[0, 0]` is the
    /// halo cell at the north-west corner, `[1, 1]` the tile's first.
    pub(crate) fn halo_cell(&self, [column, row]: [usize; 2]) -> bool {
        self.ground[row * (self.columns() + 1) + column]
    }

    /// Whether the tile's cell whose north-west node is `node` has ground.
    pub(crate) fn cell(&self, [column, row]: [usize; 2]) -> bool {
        self.halo_cell([column + 1, row + 1])
    }

    /// The number of the tile's own cells that have ground.
    pub(crate) fn count_ground_cells(&self) -> usize {
        let width = self.columns() + 1;
        (1..self.rows())
            .map(|row| {
                let cells = &self.ground[row * width + 1..row * width + self.columns()];
                cells.iter().filter(|&&ground| ground).count()
            })
            .sum()
    }

    /// The heights of the nodes that may be inserted, which are those in the interior of the
    /// ground. NaN on the tile's border, on boundaries of voids and off the ground. Row by row,
    /// `columns` × `rows`.
    pub(crate) fn inner_heights_m(&self) -> Vec<f32> {
        let (columns, rows) = (self.columns(), self.rows());
        let width = columns + 1;
        let mut inner = vec![f32::NAN; columns * rows];
        for row in 1..rows - 1 {
            let heights = self.row_m(row);
            let north = &self.ground[row * width..(row + 1) * width];
            let south = &self.ground[(row + 1) * width..(row + 2) * width];
            let out = &mut inner[row * columns..(row + 1) * columns];
            for column in 1..columns - 1 {
                if north[column] && north[column + 1] && south[column] && south[column + 1] {
                    out[column] = heights[column];
                }
            }
        }
        inner
    }
}
