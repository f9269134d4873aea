//! The distance of a TIN from heights, measured window by window.

use std::ops::Range;

use corniche_geom::{HeightGrid, IndexLists};

use crate::Tin;
use crate::triangle_rows::for_each_row;

/// The distance of a TIN from heights, and the number of heights that it covers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deviation {
    /// Largest vertical distance between the TIN and a node that it covers, in metres; 0 if it
    /// covers none.
    pub max_abs_m: f64,
    /// Nodes with a height that the TIN covers, its boundary included.
    pub covered_nodes: u64,
    /// Nodes with a height where the TIN has no triangle.
    pub uncovered_nodes: u64,
}

impl Deviation {
    /// Adds the nodes of `other`. The order of merging does not matter.
    pub fn merge(&mut self, other: Self) {
        self.max_abs_m = self.max_abs_m.max(other.max_abs_m);
        self.covered_nodes += other.covered_nodes;
        self.uncovered_nodes += other.uncovered_nodes;
    }
}

/// The position of a window of finest nodes in a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WindowPlacement {
    /// Number of finest cells from the tile's west edge to the window's first column.
    pub column: i64,
    /// Number of finest cells from the tile's north edge to the window's first row.
    pub row: i64,
    /// Number of finest cells per cell of the tile: 1 for a finest tile, else a power of two.
    pub stride: i64,
}

/// The triangles of a TIN, sorted into squares of nodes, for measuring them against many windows.
#[derive(Debug, Clone)]
pub struct TriangleBuckets {
    planes: Vec<Triangle>,
    /// Number of buckets from west to east and from north to south.
    size: [usize; 2],
    /// The triangles of each bucket, row by row.
    members: IndexLists,
}

/// Number of nodes on a side of a bucket. The window of a finest tile, many levels below, is in one
/// bucket; testing a hundred triangles is little work compared with its 66 000 nodes.
const BUCKET_NODES: usize = 16;

/// A triangle with the buckets that its bounding box meets.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    /// `[column, row]`.
    corners: [[u16; 2]; 3],
    /// Height of the first corner in metres, then the rise per cell of the tile to the east and to
    /// the south, both multiplied by `double_area`: exact, without a division.
    plane: [f64; 3],
    /// Twice the area in square cells of the tile; negative if clockwise in columns and rows.
    double_area: f64,
    low: [u16; 2],
    high: [u16; 2],
}

impl Triangle {
    fn new(corners: [[u16; 2]; 3], heights_m: [f64; 3]) -> Self {
        let [a, b, c] = corners.map(|corner| corner.map(f64::from));
        let (ab, ac) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let (ab_m, ac_m) = (heights_m[1] - heights_m[0], heights_m[2] - heights_m[0]);
        let double_area = ab[0] * ac[1] - ab[1] * ac[0];
        let east = ab_m * ac[1] - ac_m * ab[1];
        let south = ac_m * ab[0] - ab_m * ac[0];
        let bucket = |axis: usize, pick: fn(u16, u16) -> u16| {
            pick(pick(corners[0][axis], corners[1][axis]), corners[2][axis]) / BUCKET_NODES as u16
        };
        Self {
            corners,
            plane: [heights_m[0], east, south],
            double_area,
            low: [bucket(0, u16::min), bucket(1, u16::min)],
            high: [bucket(0, u16::max), bucket(1, u16::max)],
        }
    }
}

impl TriangleBuckets {
    /// Sorts the triangles of `tin`, whose heights are steps of `quantum_m`.
    #[must_use]
    pub fn new(tin: &Tin, quantum_m: f64) -> Self {
        let planes: Vec<Triangle> = tin
            .triangles()
            .iter()
            .map(|triangle| {
                let corners = triangle.map(|vertex| tin.vertices()[vertex as usize]);
                let at = corners.map(|vertex| [vertex.column, vertex.row]);
                Triangle::new(at, corners.map(|vertex| f64::from(vertex.height_q) * quantum_m))
            })
            .collect();
        let size = planes.iter().fold([0, 0], |[columns, rows]: [usize; 2], triangle| {
            [
                columns.max(usize::from(triangle.high[0]) + 1),
                rows.max(usize::from(triangle.high[1]) + 1),
            ]
        });
        let buckets_of = |triangle: &Triangle| {
            let [low, high] = [triangle.low, triangle.high].map(|bucket| bucket.map(usize::from));
            (low[1]..=high[1])
                .flat_map(move |row| (low[0]..=high[0]).map(move |column| row * size[0] + column))
        };
        let members = IndexLists::new(size[0] * size[1], planes.len(), |triangle| {
            buckets_of(&planes[triangle])
        });
        Self { planes, size, members }
    }

    /// Calls `each` once for every triangle whose bounding box may meet the nodes `low` to `high`
    /// of the tile.
    fn for_each_near(&self, low: [i64; 2], high: [i64; 2], mut each: impl FnMut(&Triangle)) {
        let bucket = |node: i64, axis: usize| {
            node.div_euclid(BUCKET_NODES as i64).min(self.size[axis] as i64 - 1)
        };
        let first = [0, 1].map(|axis| bucket(low[axis], axis).max(0) as usize);
        let last = [0, 1].map(|axis| bucket(high[axis], axis));
        for row in first[1] as i64..=last[1] {
            for column in first[0] as i64..=last[0] {
                let (row, column) = (row as usize, column as usize);
                for &member in self.members.list(row * self.size[0] + column) {
                    let triangle = &self.planes[member as usize];
                    // A triangle is in all buckets that it meets: use it only in the first of them.
                    let taken_at =
                        [0, 1].map(|axis| usize::from(triangle.low[axis]).max(first[axis]));
                    if taken_at == [column, row] {
                        each(triangle);
                    }
                }
            }
        }
    }
}

/// Measures a tile's TIN at every node with a height in `window`, a rectangle of the finest raster.
///
/// Heights are compared in f64, with the quantized TIN. A node is counted once, even where
/// triangles meet. `each` is called with the column and row (in the window, row by row) of each
/// node with a height, and with the distance of the TIN from it in metres, which is `None` without
/// a triangle.
///
/// # Panics
/// When `placement.stride` is not above 0, or puts the tile's far corner or the window beyond 2^30
/// finest cells, which is a bug of the caller: a quadtree of 256-cell tiles has at most 22 levels.
pub fn measure(
    buckets: &TriangleBuckets,
    window: &HeightGrid,
    placement: WindowPlacement,
    mut each: impl FnMut(usize, usize, Option<f64>),
) -> Deviation {
    let distances_m = distances_m(buckets, window, placement);
    let mut deviation = Deviation::default();
    let columns = window.columns().max(1);
    let rows = window.raw().chunks_exact(columns).zip(distances_m.chunks_exact(columns));
    for (row, (heights_m, distances_m)) in rows.enumerate() {
        for (column, (height_m, &distance_m)) in heights_m.iter().zip(distances_m).enumerate() {
            if height_m.is_nan() {
                continue;
            }
            let distance_m = (distance_m >= 0.0).then_some(distance_m);
            match distance_m {
                Some(distance_m) => {
                    deviation.covered_nodes += 1;
                    deviation.max_abs_m = deviation.max_abs_m.max(distance_m);
                }
                None => deviation.uncovered_nodes += 1,
            }
            each(column, row, distance_m);
        }
    }
    deviation
}

/// The distance of each node of a window from the TIN; negative without a triangle or a height.
fn distances_m(
    buckets: &TriangleBuckets,
    window: &HeightGrid,
    placement: WindowPlacement,
) -> Vec<f64> {
    let heights_m = window.raw();
    // If several triangles meet, the largest distance is taken: their planes differ by rounding.
    let mut distances_m = vec![-1.0_f64; heights_m.len()];
    buckets.for_each_stretch(placement, [window.columns(), window.rows()], |nodes, plane| {
        let scale = plane.scale.abs();
        let nodes = heights_m[nodes.clone()].iter().zip(&mut distances_m[nodes]);
        // Division does not change the order, so the largest distance of a finest tile is exact
        // except for this one rounding.
        for (step, (&height_m, most_m)) in (0_i32..).zip(nodes) {
            let scaled = f64::from(height_m) * plane.scale - plane.scaled_m(step);
            let distance_m = scaled.abs() / scale;
            // In this form, without `max`, it is one instruction for several nodes; NaN is never
            // larger.
            *most_m = if distance_m > *most_m { distance_m } else { *most_m };
        }
    });
    distances_m
}

/// Returns the heights of a tile's TIN at the nodes of a window of the finest raster, `size`
/// columns and rows, row by row; NaN without a triangle.
///
/// On finest tiles each value is the plane's height, rounded once: the same in all triangles that
/// meet at a node.
///
/// # Panics
/// Same as [`measure`].
#[must_use]
pub fn heights_m(
    buckets: &TriangleBuckets,
    size: [usize; 2],
    placement: WindowPlacement,
) -> Vec<f64> {
    let mut heights_m = vec![f64::NAN; size[0] * size[1]];
    buckets.for_each_stretch(placement, size, |nodes, plane| {
        for (step, height_m) in (0..).zip(&mut heights_m[nodes]) {
            *height_m = plane.scaled_m(step) / plane.scale;
        }
    });
    heights_m
}

/// The plane of a triangle along a row of nodes.
#[derive(Debug, Clone, Copy)]
struct RowOfPlane {
    /// All heights are multiplied by this number, so that they are exact on the finest tiles.
    scale: f64,
    first_m: f64,
    step_m: f64,
}

impl RowOfPlane {
    /// The height `step` nodes after the first, multiplied by the scale.
    #[inline]
    fn scaled_m(&self, step: i32) -> f64 {
        self.first_m + self.step_m * f64::from(step)
    }
}

impl TriangleBuckets {
    /// Calls `each` for all stretches of nodes of a window that a triangle covers, with their
    /// positions in the window.
    #[inline]
    fn for_each_stretch(
        &self,
        placement: WindowPlacement,
        [columns, rows]: [usize; 2],
        mut each: impl FnMut(Range<usize>, RowOfPlane),
    ) {
        let WindowPlacement { column: west, row: north, stride } = placement;
        let (columns, rows) = (columns as i64, rows as i64);
        let reach = self.size.map(|count| (count * BUCKET_NODES) as i64);
        assert!(
            stride > 0
                && reach[0].max(reach[1]).checked_mul(stride).is_some_and(|far| far <= 17 << 26),
            "a tile of {reach:?} nodes at a stride of {stride}"
        );
        if columns == 0 || rows == 0 {
            return;
        }
        let low = [west.div_euclid(stride), north.div_euclid(stride)];
        let high = [(west + columns - 1).div_euclid(stride), (north + rows - 1).div_euclid(stride)];
        self.for_each_near(low, high, |triangle| {
            let corners =
                triangle.corners.map(|corner| corner.map(|node| i64::from(node) * stride));
            let scale = triangle.double_area * stride as f64;
            let [at_m, east, south] = triangle.plane;
            let [from_column, from_row] = corners[0];
            for_each_row(corners, north..=north + rows - 1, |row, first, last| {
                let (first, last) = (first.max(west), last.min(west + columns - 1));
                if last < first {
                    return;
                }
                let start = ((row - north) * columns + first - west) as usize;
                let first_m = at_m * scale
                    + south * (row - from_row) as f64
                    + east * (first - from_column) as f64;
                let plane = RowOfPlane { scale, first_m, step_m: east };
                each(start..start + (last - first) as usize + 1, plane);
            });
        });
    }
}

#[cfg(test)]
#[path = "deviation_tests.rs"]
mod tests;
