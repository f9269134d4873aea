//! A regular grid of heights in metres, with gaps.

/// The number of heights that are compared at the same time.
const LANES: usize = 8;

/// A regular grid of heights in metres, row by row, with row 0 in the north. A gap has no height.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightGrid {
    columns: usize,
    rows: usize,
    /// NaN marks a gap; the field is private so that no caller compares with a sentinel.
    heights_m: Vec<f32>,
}

impl HeightGrid {
    /// Creates a grid from its heights, row by row from the north; every value that is not finite
    /// becomes a gap.
    ///
    /// # Panics
    /// When `heights_m` does not have `columns` × `rows` values, which is a bug of the caller.
    #[must_use]
    pub fn new(columns: usize, rows: usize, mut heights_m: Vec<f32>) -> Self {
        assert_eq!(heights_m.len(), columns * rows, "a grid of {columns} × {rows}");
        for height_m in &mut heights_m {
            // All gaps are the same NaN, and all zeros are the same zero, so that equal grids have
            // equal bits.
            *height_m = if height_m.is_finite() { *height_m + 0.0 } else { f32::NAN };
        }
        Self { columns, rows, heights_m }
    }

    /// Creates a grid from `height_m(column, row)`.
    #[must_use]
    pub fn from_fn(
        columns: usize,
        rows: usize,
        mut height_m: impl FnMut(usize, usize) -> f32,
    ) -> Self {
        let mut heights_m = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            for column in 0..columns {
                heights_m.push(height_m(column, row));
            }
        }
        Self::new(columns, rows, heights_m)
    }

    /// The number of nodes from west to east.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The number of nodes from north to south.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The height of a node; `None` in a gap.
    ///
    /// # Panics
    /// When the node is outside the grid.
    #[must_use]
    #[inline]
    pub fn height(&self, column: usize, row: usize) -> Option<f32> {
        let height_m = self.raw()[row * self.columns + column];
        (!height_m.is_nan()).then_some(height_m)
    }

    /// Whether a node has a height.
    ///
    /// # Panics
    /// When the node is outside the grid.
    #[must_use]
    #[inline]
    pub fn has_height(&self, column: usize, row: usize) -> bool {
        !self.heights_m[row * self.columns + column].is_nan()
    }

    /// Whether the cell whose north-west node is (`column`, `row`) has ground, which means that all
    /// four corners have a height.
    ///
    /// # Panics
    /// When the cell is outside the grid.
    #[must_use]
    #[inline]
    pub fn cell_has_ground(&self, column: usize, row: usize) -> bool {
        self.has_height(column, row)
            && self.has_height(column + 1, row)
            && self.has_height(column, row + 1)
            && self.has_height(column + 1, row + 1)
    }

    /// All heights row by row from the north, NaN in gaps; for loops over all nodes and for
    /// storage.
    #[must_use]
    pub fn raw(&self) -> &[f32] {
        &self.heights_m
    }

    /// The number of nodes that have a height.
    #[must_use]
    pub fn count_heights(&self) -> usize {
        self.heights_m.iter().filter(|height_m| !height_m.is_nan()).count()
    }

    /// The lowest and the highest height; `None` if no node has a height.
    #[must_use]
    pub fn range_m(&self) -> Option<[f32; 2]> {
        // Several heights are compared at a time; comparisons with NaN are false.
        let (chunks, rest) = self.heights_m.as_chunks::<LANES>();
        let (mut low, mut high) = ([f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]);
        let mut look = |lane: usize, height_m: f32| {
            low[lane] = if height_m < low[lane] { height_m } else { low[lane] };
            high[lane] = if height_m > high[lane] { height_m } else { high[lane] };
        };
        for chunk in chunks {
            for (lane, &height_m) in chunk.iter().enumerate() {
                look(lane, height_m);
            }
        }
        for &height_m in rest {
            look(0, height_m);
        }
        let range_m = [
            low.into_iter().fold(f32::INFINITY, f32::min),
            high.into_iter().fold(f32::NEG_INFINITY, f32::max),
        ];
        (range_m[0] <= range_m[1]).then_some(range_m)
    }

    /// Returns the rectangle of `columns` × `rows` nodes whose north-west node is (`column`,
    /// `row`).
    ///
    /// # Panics
    /// When the rectangle extends outside the grid.
    #[must_use]
    pub fn window(&self, column: usize, row: usize, columns: usize, rows: usize) -> Self {
        assert!(column + columns <= self.columns && row + rows <= self.rows, "a window outside");
        let mut heights_m = Vec::with_capacity(columns * rows);
        for row in row..row + rows {
            let from = row * self.columns + column;
            heights_m.extend_from_slice(&self.heights_m[from..from + columns]);
        }
        Self { columns, rows, heights_m }
    }

    /// Returns the grid without `margin` nodes on every side.
    ///
    /// # Panics
    /// When the grid has no other nodes.
    #[must_use]
    pub fn inner(&self, margin: usize) -> Self {
        let [columns, rows] = [self.columns, self.rows].map(|nodes| nodes - 2 * margin);
        self.window(margin, margin, columns, rows)
    }
}

#[cfg(test)]
#[path = "height_grid_tests.rs"]
mod tests;
