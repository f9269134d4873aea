//! A grid that finds the triangles of a surface near a place.

use std::ops::RangeInclusive;

use corniche_geom::IndexLists;
use serde::{Deserialize, Serialize};

use super::blocks;

/// Cells along each side of a grid.
const SIDE: usize = 32;
/// A share of its extent by which a triangle reaches beyond its corners: look-ups accept each of its barycentric weights
/// down to a millionth below 0, and the sum of two of them. The rest is for rounding.
const SLACK: f64 = 4e-6;

/// Which triangles of a surface are near a place in plan: a grid of cells over the surface, each with the triangles whose
/// bounding boxes it touches.
///
/// Takes 4 KiB a tile, and 4 bytes for each cell that the box around a triangle touches: some 8 bytes a triangle where
/// they are smaller than cells, and at most 4 KiB a triangle where they are as large as the tile.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct TriangleGrid {
    /// West and south of the surface.
    min: [f64; 2],
    /// Cells per metre along each axis.
    cells_per_m: [f64; 2],
    /// How far triangles may reach beyond the cells in which their corners lie, metres.
    slack_m: f64,
    /// The triangles of each cell, row by row from the south.
    #[serde(with = "blocks::index_lists")]
    triangles: IndexLists,
}

impl TriangleGrid {
    /// A grid of triangles whose corners in plan are these.
    pub(crate) fn new(triangles: impl Iterator<Item = [[f64; 2]; 3]>) -> Self {
        let boxes: Vec<[[f64; 2]; 2]> = triangles
            .map(|corners| corners.iter().fold(NO_BOX, |around, at| grown(around, [*at, *at])))
            .collect();
        if boxes.is_empty() {
            return Self::default();
        }
        let [min, max] = boxes.iter().fold(NO_BOX, |around, of_one| grown(around, *of_one));
        let extent_m = [0, 1].map(|axis: usize| (max[axis] - min[axis]).max(f64::MIN_POSITIVE));
        let mut grid = Self {
            min,
            cells_per_m: extent_m.map(|side_m| SIDE as f64 / side_m),
            slack_m: extent_m[0].max(extent_m[1]) * SLACK,
            triangles: IndexLists::default(),
        };
        let touched: Vec<[RangeInclusive<usize>; 2]> =
            boxes.iter().map(|[low, high]| grid.ranges(*low, *high)).collect();
        grid.triangles = IndexLists::new(SIDE * SIDE, touched.len(), |triangle| {
            let [columns, rows] = touched[triangle].clone();
            rows.flat_map(move |row| columns.clone().map(move |column| row * SIDE + column))
        });
        grid
    }

    /// The triangles that may hold a place, ascending; all that hold it are among them.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> &[u32] {
        if self.triangles.is_empty() {
            return &[];
        }
        self.triangles.of(self.cell(1, y) * SIDE + self.cell(0, x))
    }

    /// The triangles that a level line from one place to another may meet, column by column on the way, and for each
    /// column the share of the way at which it begins. A triangle may come several times.
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
            // The outermost columns hold what lies beyond them too.
            let edge_m = |column: usize| self.min[0] + column as f64 / self.cells_per_m[0];
            let west_m =
                if column == 0 { f64::NEG_INFINITY } else { edge_m(column) - self.slack_m };
            let is_last = column == SIDE - 1;
            let east_m = if is_last { f64::INFINITY } else { edge_m(column + 1) + self.slack_m };
            let share = |x: f64| ((x - from[0]) / way[0]).clamp(0.0, 1.0);
            // A way along the column is in it from end to end.
            let (enters, leaves) = match way[0] {
                0.0 => (0.0, 1.0),
                ahead if ahead > 0.0 => (share(west_m), share(east_m)),
                _ => (share(east_m), share(west_m)),
            };
            let y = [enters, leaves].map(|share| from[1] + way[1] * share);
            let rows = self.ranges([0.0, y[0].min(y[1])], [0.0, y[0].max(y[1])])[1].clone();
            let near =
                rows.flat_map(move |row| self.triangles.of(row * SIDE + column).iter().copied());
            (enters, near)
        })
    }

    /// The triangles that may meet a box; some may come several times.
    pub(crate) fn within(&self, low: [f64; 2], high: [f64; 2]) -> impl Iterator<Item = u32> {
        let ranges = (!self.triangles.is_empty()).then(|| self.ranges(low, high));
        ranges.into_iter().flat_map(move |[columns, rows]| {
            rows.flat_map(move |row| {
                let places = columns.clone().map(move |column| row * SIDE + column);
                places.flat_map(|place| self.triangles.of(place).iter().copied())
            })
        })
    }

    /// Columns and rows of all that lies within the slack of a box.
    fn ranges(&self, low: [f64; 2], high: [f64; 2]) -> [RangeInclusive<usize>; 2] {
        [0, 1].map(|axis| {
            self.cell(axis, low[axis] - self.slack_m)..=self.cell(axis, high[axis] + self.slack_m)
        })
    }

    /// The column or row of a place; of places outside the one next to them.
    fn cell(&self, axis: usize, at: f64) -> usize {
        // A cast turns what is below 0, or not a number, into 0.
        (((at - self.min[axis]) * self.cells_per_m[axis]) as usize).min(SIDE - 1)
    }
}

/// A box that holds nothing: grown by another it is that other.
const NO_BOX: [[f64; 2]; 2] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];

/// The box around two boxes.
fn grown([low, high]: [[f64; 2]; 2], [other_low, other_high]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [
        [0, 1].map(|axis: usize| low[axis].min(other_low[axis])),
        [0, 1].map(|axis: usize| high[axis].max(other_high[axis])),
    ]
}

#[cfg(test)]
#[path = "triangle_grid_tests.rs"]
mod tests;
