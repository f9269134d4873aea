//! A grid of buckets for bounding boxes.

use corniche_geom::{IndexLists, LatticeBounds, LatticePoint};

/// Indices of boxes by the squares that they meet, in ascending order for each square.
///
/// The side of a square is a power of two steps, so that finding a square is a shift.
#[derive(Debug, Clone)]
pub(crate) struct Buckets {
    bounds: LatticeBounds,
    shift: u32,
    columns: usize,
    rows: usize,
    /// The boxes of each square, row by row.
    items: IndexLists,
}

impl Default for Buckets {
    fn default() -> Self {
        // Bounds without points: nothing is ever found.
        let bounds = LatticeBounds { min: LatticePoint::new(1, 1), max: LatticePoint::new(0, 0) };
        Self { bounds, shift: 0, columns: 0, rows: 0, items: IndexLists::default() }
    }
}

impl Buckets {
    /// Sorts boxes into about as many squares as there are boxes, or fewer if boxes are large: the
    /// number of entries is at most eight per box, whatever the boxes are.
    pub(crate) fn new(boxes: &[LatticeBounds]) -> Self {
        let corners: Vec<LatticePoint> = boxes.iter().flat_map(|b| [b.min, b.max]).collect();
        let Some(bounds) = LatticeBounds::around(&corners) else {
            return Self::default();
        };
        let longest = (bounds.max.u - bounds.min.u).max(bounds.max.v - bounds.min.v);
        let most = boxes.len().isqrt().max(1) as i64;
        let mut shift = 0;
        while longest >> shift >= most {
            shift += 1;
        }
        loop {
            let mut grid = Self { bounds, shift, ..Self::default() };
            let [columns, rows] = grid.square(bounds.max);
            (grid.columns, grid.rows) = (columns + 1, rows + 1);
            let entries: usize = boxes
                .iter()
                .map(|b| {
                    let ([west, south], [east, north]) = (grid.square(b.min), grid.square(b.max));
                    (east - west + 1) * (north - south + 1)
                })
                .sum();
            if entries <= 8 * boxes.len() || grid.columns * grid.rows == 1 {
                grid.fill(boxes);
                return grid;
            }
            shift += 1;
        }
    }

    /// The boxes of the square that contains `point`, ascending.
    pub(crate) fn at(&self, point: LatticePoint) -> &[u32] {
        if !self.bounds.contains(point) {
            return &[];
        }
        let [column, row] = self.square(point);
        self.bucket(column, row)
    }

    /// Finds the boxes of squares that meet `near`, ascending, without repetition; `out` is cleared
    /// first.
    pub(crate) fn near(&self, near: LatticeBounds, out: &mut Vec<u32>) {
        out.clear();
        self.visit(near, |item| out.push(item));
        out.sort_unstable();
        out.dedup();
    }

    /// Visits the boxes of squares that meet `near`, square by square.
    pub(crate) fn visit(&self, near: LatticeBounds, mut visit: impl FnMut(u32)) {
        if self.items.is_empty() || !self.bounds.intersects(&near) {
            return;
        }
        let within = |p: LatticePoint| {
            let (min, max) = (self.bounds.min, self.bounds.max);
            self.square(LatticePoint::new(p.u.clamp(min.u, max.u), p.v.clamp(min.v, max.v)))
        };
        let ([west, south], [east, north]) = (within(near.min), within(near.max));
        for row in south..=north {
            for column in west..=east {
                self.bucket(column, row).iter().for_each(|&item| visit(item));
            }
        }
    }

    /// Visits the boxes of squares within `around` steps of a segment along each axis, square by
    /// square: for a long diagonal segment these are far fewer than those that meet its bounding
    /// box.
    pub(crate) fn visit_along(
        &self,
        [p, q]: [[f64; 2]; 2],
        around: f64,
        mut visit: impl FnMut(u32),
    ) {
        if self.items.is_empty() {
            return;
        }
        let (min, max) = (self.bounds.min.in_steps(), self.bounds.max.in_steps());
        let side = (1_i64 << self.shift) as f64;
        let (low, high) = (p[1].min(q[1]) - around, p[1].max(q[1]) + around);
        if high < min[1] || low > max[1] {
            return;
        }
        let row_of = |v: f64| (((v - min[1]) / side).floor().max(0.0) as usize).min(self.rows - 1);
        for row in row_of(low)..=row_of(high) {
            // The part of the segment near this row.
            let south = min[1] + row as f64 * side;
            let band = [south - around, south + side + around];
            let rise = q[1] - p[1];
            let shares = if rise == 0.0 {
                [0.0, 1.0]
            } else {
                let [one, other] = band.map(|v| (v - p[1]) / rise);
                [one.min(other).max(0.0), one.max(other).min(1.0)]
            };
            if shares[0] > shares[1] {
                continue;
            }
            let [from, to] = shares.map(|share| p[0] + share * (q[0] - p[0]));
            let (west, east) = (from.min(to) - around, from.max(to) + around);
            if east < min[0] || west > max[0] {
                continue;
            }
            let column_of =
                |u: f64| (((u - min[0]) / side).floor().max(0.0) as usize).min(self.columns - 1);
            for column in column_of(west)..=column_of(east) {
                self.bucket(column, row).iter().for_each(|&item| visit(item));
            }
        }
    }

    /// The column and the row of the square of a point within the bounds.
    fn square(&self, point: LatticePoint) -> [usize; 2] {
        [point.u - self.bounds.min.u, point.v - self.bounds.min.v]
            .map(|offset| (offset >> self.shift) as usize)
    }

    fn bucket(&self, column: usize, row: usize) -> &[u32] {
        self.items.list(row * self.columns + column)
    }

    /// Adds each box to the squares that it meets.
    fn fill(&mut self, boxes: &[LatticeBounds]) {
        let columns = self.columns;
        let squares = |index: usize| {
            let LatticeBounds { min, max } = boxes[index];
            let ([west, south], [east, north]) = (self.square(min), self.square(max));
            (south..=north)
                .flat_map(move |row| (west..=east).map(move |column| row * columns + column))
        };
        self.items = IndexLists::new(self.columns * self.rows, boxes.len(), squares);
    }
}
