//! A grid that finds the triangles of a surface near a position.

use std::ops::RangeInclusive;

use corniche_geom::{Bounds, IndexLists};
use serde::{Deserialize, Serialize};

use super::blocks;

/// Cells along each side of a grid.
const SIDE: usize = 32;
/// How far a triangle extends beyond its corners, as a share of its extent: look-ups accept each of
/// its barycentric weights down to a millionth below 0, and the sum of two of them. The remainder
/// is for rounding.
const SLACK: f64 = 4e-6;

/// Finds the triangles of a surface near a position in plan: a grid of cells over the surface, each
/// with the triangles whose bounding boxes it touches.
///
/// Takes 4 KiB per tile, and 4 bytes for each cell that the bounding box of a triangle touches:
/// some 8 bytes per triangle if triangles are smaller than cells, and at most 4 KiB per triangle if
/// they are as large as the tile.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct TriangleGrid {
    /// West and south of the surface.
    min: [f64; 2],
    /// Cells per metre along each axis.
    cells_per_m: [f64; 2],
    /// How far triangles may extend beyond the cells that contain their corners, metres.
    slack_m: f64,
    /// The triangles of each cell, row by row from the south.
    #[serde(with = "blocks::index_lists")]
    triangles: IndexLists,
}

impl TriangleGrid {
    /// Creates a grid of triangles with these corners in plan.
    pub(crate) fn new(triangles: impl Iterator<Item = [[f64; 2]; 3]>) -> Self {
        let boxes: Vec<Bounds> = triangles.map(|corners| Bounds::around(&corners)).collect();
        if boxes.is_empty() {
            return Self::default();
        }
        let all = boxes.iter().fold(Bounds::EMPTY, |all, one| all.union(one));
        let extent_m = [all.width(), all.height()].map(|side_m| side_m.max(f64::MIN_POSITIVE));
        let mut grid = Self {
            min: [all.min_x, all.min_y],
            cells_per_m: extent_m.map(|side_m| SIDE as f64 / side_m),
            slack_m: extent_m[0].max(extent_m[1]) * SLACK,
            triangles: IndexLists::default(),
        };
        let touched: Vec<[RangeInclusive<usize>; 2]> = boxes
            .iter()
            .map(|of| grid.ranges([of.min_x, of.min_y], [of.max_x, of.max_y]))
            .collect();
        grid.triangles = IndexLists::new(SIDE * SIDE, touched.len(), |triangle| {
            let [columns, rows] = touched[triangle].clone();
            rows.flat_map(move |row| columns.clone().map(move |column| row * SIDE + column))
        });
        grid
    }

    /// The triangles that may contain a position, ascending; all that contain it are included.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> &[u32] {
        if self.triangles.is_empty() {
            return &[];
        }
        self.triangles.list(self.cell(1, y) * SIDE + self.cell(0, x))
    }

    /// The triangles that a level line from one position to another may intersect, column by column
    /// along the line; for each column the share of the line at which it begins. A triangle may
    /// occur several times.
    pub(crate) fn along(
        &self,
        from: [f64; 2],
        to: [f64; 2],
    ) -> impl Iterator<Item = (f64, impl Iterator<Item = u32>)> {
        let way = [0, 1].map(|axis| to[axis] - from[axis]);
        let (first, last) = (self.cell(0, from[0].min(to[0])), self.cell(0, from[0].max(to[0])));
        let columns = if self.triangles.is_empty() { 0 } else { last - first + 1 };
        (0..columns).map(move |step| {
            let column = if way[0] < 0.0 { last - step } else { first + step };
            // The outermost columns also hold the triangles beyond them.
            let edge_m = |column: usize| self.min[0] + column as f64 / self.cells_per_m[0];
            let west_m =
                if column == 0 { f64::NEG_INFINITY } else { edge_m(column) - self.slack_m };
            let is_last = column == SIDE - 1;
            let east_m = if is_last { f64::INFINITY } else { edge_m(column + 1) + self.slack_m };
            let share = |x: f64| ((x - from[0]) / way[0]).clamp(0.0, 1.0);
            // A line along the column is inside it from end to end.
            let (enters, leaves) = match way[0] {
                0.0 => (0.0, 1.0),
                ahead if ahead > 0.0 => (share(west_m), share(east_m)),
                _ => (share(east_m), share(west_m)),
            };
            let y = [enters, leaves].map(|share| from[1] + way[1] * share);
            let rows = self.ranges([0.0, y[0].min(y[1])], [0.0, y[0].max(y[1])])[1].clone();
            let near =
                rows.flat_map(move |row| self.triangles.list(row * SIDE + column).iter().copied());
            (enters, near)
        })
    }

    /// The triangles that may intersect a box; some may occur several times.
    pub(crate) fn within(&self, low: [f64; 2], high: [f64; 2]) -> impl Iterator<Item = u32> {
        let ranges = (!self.triangles.is_empty()).then(|| self.ranges(low, high));
        ranges.into_iter().flat_map(move |[columns, rows]| {
            rows.flat_map(move |row| {
                let places = columns.clone().map(move |column| row * SIDE + column);
                places.flat_map(|place| self.triangles.list(place).iter().copied())
            })
        })
    }

    /// The columns and rows within the tolerance of a box.
    fn ranges(&self, low: [f64; 2], high: [f64; 2]) -> [RangeInclusive<usize>; 2] {
        [0, 1].map(|axis| {
            self.cell(axis, low[axis] - self.slack_m)..=self.cell(axis, high[axis] + self.slack_m)
        })
    }

    /// The column or row of a position; positions outside get the nearest one.
    fn cell(&self, axis: usize, at: f64) -> usize {
        // A cast turns negative values and NaN into 0.
        (((at - self.min[axis]) * self.cells_per_m[axis]) as usize).min(SIDE - 1)
    }
}

#[cfg(test)]
#[path = "triangle_grid_tests.rs"]
mod tests;
